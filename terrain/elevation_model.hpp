// Inside terrain only: the height of the ground above the ellipsoid over the map plane.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "terrain/elevation_raster.hpp"
#include "terrain/height_pyramid.hpp"
#include "terrain/map_plane.hpp"
#include "terrain/smooth_map.hpp"
#include "terrain/world.hpp"

namespace overfly::terrain {

/// Filled blocks of an elevation model that were made before. Thread-safe.
class HeightStore {
 public:
  HeightStore() = default;
  HeightStore(const HeightStore&) = delete;
  HeightStore& operator=(const HeightStore&) = delete;
  virtual ~HeightStore() = default;
  [[nodiscard]] virtual const HeightSurvey& survey() const = 0;
  /// Errors: kIo naming the file.
  [[nodiscard]] virtual Result<HeightGrid> block(int level, int column, int row) const = 0;
};

/// Continuous everywhere; beyond the posts it goes on with the edge's value. Heights are read in
/// blocks when asked for. Thread-safe once it was surveyed or given a store.
class ElevationModel {
 public:
  static ElevationModel flat(double height_m);

  /// Opens the layers over `area` of the map plane. One layer is sampled at its own posts;
  /// several are laid onto one grid of the finest spacing, the first that has data wins.
  /// @param imagery    the part of the map where missing elevation is worth a warning
  /// @param max_posts  more is kUnsupported, so that the caller may ask for a smaller area
  /// Errors: as ElevationRaster::open; kInvalidArgument if none overlaps the imagery.
  static Result<ElevationModel> open(const std::vector<ElevationLayer>& layers,
                                     const MapPlane& plane,
                                     const MapRect& imagery,
                                     const MapRect& area,
                                     double max_posts,
                                     std::vector<std::string>& warnings);

  /// Reads every post once: range, voids. Doubts go to `warnings`.
  /// @param cancelled  asked before each block of posts; may be empty
  /// Errors: kIo; kCancelled; kInvalidArgument if no post has data.
  Status survey(const std::function<bool()>& cancelled, std::vector<std::string>& warnings);
  /// Takes heights from a store instead, made from a model with the same fingerprint.
  Status use(std::shared_ptr<const HeightStore> store, std::vector<std::string>& warnings);

  /// Ellipsoidal height [m].
  [[nodiscard]] double height_m(double x_map_m, double y_map_m) const;
  /// Of the level whose posts are at most `spacing_m` apart (the finest where none is).
  [[nodiscard]] double coarse_height_m(double x_map_m, double y_map_m, double spacing_m) const;
  /// Lowest and highest ellipsoidal height [m].
  [[nodiscard]] Eigen::Vector2d range_m() const { return range_m_; }
  /// Distance between posts on the map [m]; 0 for flat ground.
  [[nodiscard]] double spacing_m() const { return spacing_m_; }
  /// kIo once heights could not be read: those places have the lowest height instead.
  [[nodiscard]] Status status() const;
  /// What the posts are and how they became ellipsoidal: equal for equal heights.
  [[nodiscard]] std::string fingerprint() const;
  /// How each layer became ellipsoidal: the grid's name, a constant, or nothing.
  [[nodiscard]] std::vector<std::string> relations() const;
  /// What the heights of each layer count from.
  [[nodiscard]] std::vector<HeightDatum> datums() const;
  /// Null for flat ground.
  [[nodiscard]] const PagedHeights* heights() const { return parts_ ? parts_->heights : nullptr; }
  [[nodiscard]] const HeightSurvey& survey_result() const { return survey_; }

 private:
  /// What blocks are made from; stays where it is when the model moves.
  struct Parts {
    std::vector<std::shared_ptr<ElevationRaster>> rasters;
    std::shared_ptr<BlockCache> cache;
    std::unique_ptr<HeightPyramid> pyramid;
    std::shared_ptr<const HeightStore> store;
    std::unique_ptr<PagedHeights> stored;
    const PagedHeights* heights = nullptr;
  };

  Status merge(const MapRect& area, double max_posts, std::vector<std::string>& warnings);
  Status take(const HeightSurvey& survey, std::vector<std::string>& warnings);
  [[nodiscard]] double at_level(int level, double x_map_m, double y_map_m) const;

  std::shared_ptr<Parts> parts_;
  std::optional<SmoothMap<2>> post_from_map_;
  std::string what_;  ///< the file, for messages
  double flat_height_m_ = 0.0;
  double spacing_m_ = 0.0;
  Eigen::Vector2d range_m_{0.0, 0.0};
  HeightSurvey survey_;
};

}  // namespace overfly::terrain
