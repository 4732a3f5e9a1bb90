// Inside terrain only: the height of the ground above the ellipsoid over the map plane.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "terrain/elevation/elevation_raster.hpp"
#include "terrain/elevation/height_pyramid.hpp"
#include "terrain/place/map_plane.hpp"
#include "terrain/place/smooth_map.hpp"
#include "terrain/world.hpp"

namespace overfly::terrain {

/// The two grids of posts of an elevation model: the fine one around the imagery and, where that
/// does not reach far enough, a coarser one.
enum class HeightReach { kNear, kFar };

/// Precomputed filled blocks of an elevation model. Thread-safe.
class HeightStore {
 public:
  HeightStore() = default;
  HeightStore(const HeightStore&) = delete;
  HeightStore& operator=(const HeightStore&) = delete;
  virtual ~HeightStore() = default;
  /// Null if there is no such grid.
  [[nodiscard]] virtual const HeightSurvey* survey(HeightReach reach) const = 0;
  /// Errors: kIo naming the file.
  [[nodiscard]] virtual Result<HeightGrid> block(HeightReach reach,
                                                 int level,
                                                 int column,
                                                 int row) const = 0;
};

/// Continuous everywhere; beyond the posts the edge's value continues. Heights are read in blocks
/// on demand. Thread-safe after a survey or after it was given a store.
class ElevationModel {
 public:
  static ElevationModel flat(double height_m);

  /// Opens the layers over `area` of the map plane. A single layer is sampled at its own posts.
  /// Several layers are resampled to one grid of the finest spacing, aligned with the posts of the
  /// finest layer if it is parallel to the map; the first one with data wins.
  /// @param imagery  the part of the map where missing elevation causes a warning
  /// @param max_posts  more is kUnsupported, so that the caller may request a smaller area
  /// Errors: as ElevationRaster::open; kInvalidArgument if none overlaps the imagery.
  static Result<ElevationModel> open(const std::vector<ElevationLayer>& layers,
                                     const MapPlane& plane,
                                     const MapRect& imagery,
                                     const MapRect& area,
                                     double max_posts,
                                     std::vector<std::string>& warnings);

  /// Adds a coarser grid of the same layers over a larger area. It is used outside of the model's
  /// own area; over the outer half of the margin around the imagery one passes into the other.
  /// @param imagery  as for `open`
  /// @param max_posts  of the coarser grid
  /// Errors: as ElevationRaster::open.
  [[nodiscard]] Status extend(const std::vector<ElevationLayer>& layers,
                              const MapPlane& plane,
                              const MapRect& imagery,
                              const MapRect& area,
                              double max_posts);

  /// Reads every post once: range, voids. Doubts are added to `warnings`.
  /// @param cancelled  polled before each block of posts; may be empty
  /// Errors: kIo; kCancelled; kInvalidArgument if no post has data.
  Status survey(const std::function<bool()>& cancelled, std::vector<std::string>& warnings);
  /// Uses heights from a store instead, made from a model with the same fingerprint.
  Status use(std::shared_ptr<const HeightStore> store, std::vector<std::string>& warnings);

  /// Ellipsoidal height [m].
  [[nodiscard]] double height_m(double x_map_m, double y_map_m) const;
  /// From the level whose posts are at most `spacing_m` apart (or the finest level).
  [[nodiscard]] double coarse_height_m(double x_map_m, double y_map_m, double spacing_m) const;
  /// Lowest and highest ellipsoidal height [m].
  [[nodiscard]] Eigen::Vector2d range_m() const { return range_m_; }
  /// Distance between posts on the map [m]; 0 for flat ground.
  [[nodiscard]] double spacing_m() const { return spacing_m_; }
  /// The coarser grid of `extend`; null if there is none, or no post of it has data.
  [[nodiscard]] const ElevationModel* far() const { return far_has_data_ ? far_.get() : nullptr; }
  /// How far around the imagery the fine posts reach if there is a coarser grid [m].
  [[nodiscard]] double near_reach_m() const { return near_reach_m_; }
  /// kIo after a read error: the height at such places is the lowest height.
  [[nodiscard]] Status status() const;
  /// Identifies the posts and their conversion to ellipsoidal heights; equal for equal heights.
  [[nodiscard]] std::string fingerprint() const;
  /// How each layer was converted to ellipsoidal heights: the grid's name, a constant, or nothing.
  [[nodiscard]] std::vector<std::string> relations() const;
  /// The vertical datum of each layer.
  [[nodiscard]] std::vector<HeightDatum> datums() const;
  /// Null for flat ground.
  [[nodiscard]] const PagedHeights* heights() const { return parts_ ? parts_->heights : nullptr; }
  [[nodiscard]] const HeightSurvey& survey_result() const { return survey_; }

 private:
  /// The sources of blocks; keeps its address when the model is moved.
  struct Parts {
    std::vector<std::shared_ptr<ElevationRaster>> rasters;
    std::shared_ptr<BlockCache> cache;
    std::unique_ptr<HeightPyramid> pyramid;
    std::shared_ptr<const HeightStore> store;
    std::unique_ptr<PagedHeights> stored;
    const PagedHeights* heights = nullptr;
  };

  Status open_layers(const std::vector<ElevationLayer>& layers,
                     const MapPlane& plane,
                     const MapRect& area,
                     const std::vector<int>& steps,
                     std::vector<std::string>& warnings);
  Status lay_grid(const MapRect& area,
                  double least_spacing_m,
                  double max_posts,
                  std::vector<std::string>& warnings);
  Status merge(const MapRect& covered,
               double least_spacing_m,
               double max_posts,
               std::vector<std::string>& warnings);
  Status use(std::shared_ptr<const HeightStore> store,
             HeightReach reach,
             std::vector<std::string>& warnings);
  Status survey_posts(const std::function<bool()>& cancelled, std::vector<std::string>& warnings);
  Status take(const HeightSurvey& survey, std::vector<std::string>& warnings);
  Status take_far(const Status& known,
                  const std::vector<std::string>& doubts,
                  std::vector<std::string>& warnings);
  [[nodiscard]] double near_share(double x_map_m, double y_map_m) const;
  [[nodiscard]] double at_level(int level, double x_map_m, double y_map_m) const;

  std::shared_ptr<Parts> parts_;
  std::shared_ptr<ElevationModel> far_;  ///< the coarser grid
  bool far_has_data_ = false;
  MapRect area_;  ///< of the fine grid
  double near_reach_m_ = 0.0;
  std::optional<SmoothMap<2>> post_from_map_;
  std::string what_;  ///< the file, for messages
  double flat_height_m_ = 0.0;
  double spacing_m_ = 0.0;
  Eigen::Vector2d range_m_{0.0, 0.0};
  HeightSurvey survey_;
};

}  // namespace overfly::terrain
