// Inside terrain only: one elevation file as ellipsoidal heights in metres at its own posts, read
// in parts.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "terrain/cancelled.hpp"
#include "terrain/elevation/elevation_units.hpp"
#include "terrain/elevation/height_pyramid.hpp"
#include "terrain/elevation/void_plateaus.hpp"
#include "terrain/place/map_plane.hpp"
#include "terrain/place/smooth_map.hpp"
#include "terrain/raster/gdal_dataset.hpp"
#include "terrain/raster/georeference.hpp"
#include "terrain/world.hpp"

namespace overfly::terrain {

/// Thread-safe after `open`.
class ElevationRaster {
 public:
  /// Opens the file and determines which of its posts lie over `area` of the map plane and how they
  /// are converted to metres above the ellipsoid. Doubts about unit and datum are added to
  /// `warnings`.
  /// @param cache  holds the posts that `height_m` read
  /// @param step  only every step-th post of a row and of a column is used
  /// Errors: kNotFound, kUnreadable, kInvalidArgument naming the file.
  static Result<std::shared_ptr<ElevationRaster>> open(const ElevationLayer& layer,
                                                       const MapPlane& plane,
                                                       const MapRect& area,
                                                       std::shared_ptr<BlockCache> cache,
                                                       int step,
                                                       std::vector<std::string>& warnings);

  /// Checks for signs of a damaged file. Errors: kUnreadable, kNotFound naming it.
  [[nodiscard]] Status check(const Cancelled& cancelled, std::vector<std::string>& warnings) const;
  /// Searches all posts for undeclared no-data values, if reading has found candidates; they are
  /// NaN from then on. Must not run while other threads read.
  /// @param cancelled  polled before each strip; may be empty
  /// @return whether there are any. Errors: kIo; kCancelled
  Result<bool> find_undeclared_voids(const Cancelled& cancelled);
  [[nodiscard]] const VoidRuns& undeclared_voids() const { return voids_; }

  /// Posts of the window over the area, NaN where the file has no data.
  /// Errors: kIo with GDAL's reason.
  [[nodiscard]] Result<RawPosts> read(int column, int row, int columns, int rows) const;

  /// True within half a post of the window's posts.
  [[nodiscard]] bool covers(double x_map_m, double y_map_m) const;
  /// Fraction of an area of the map within half a post of the window's posts: exact if the raster
  /// is parallel to the map, else of the area's bounding box in posts.
  [[nodiscard]] double overlap_share(const MapRect& area) const;
  /// Pixels of the file that are read to have every post once.
  [[nodiscard]] double pixels_read() const {
    const double step = has_overviews_ ? 1.0 : step_;
    return step * step * window_.columns * window_.rows;
  }
  /// NaN outside, where there is no data, and where the file cannot be read (see HeightErrors).
  [[nodiscard]] double height_m(double x_map_m, double y_map_m) const;

  /// True if `height_m` found values that do not occur on earth.
  [[nodiscard]] bool implausible_seen() const { return implausible_; }

  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] const SmoothMap<2>& post_from_map() const { return *post_from_map_; }
  [[nodiscard]] int columns() const { return window_.columns; }
  [[nodiscard]] int rows() const { return window_.rows; }
  /// The places of imagery and elevation, in brackets, for an error message.
  [[nodiscard]] const std::string& whereabouts() const { return whereabouts_; }
  /// Distance between posts on the map at the area's middle [m].
  [[nodiscard]] double spacing_m() const { return spacing_m_; }
  /// How its heights were related to the ellipsoid: the grid's name, a constant, or nothing.
  [[nodiscard]] const std::string& relation() const { return relation_; }
  /// The vertical datum of its heights, from the manifest or else from the file.
  [[nodiscard]] const HeightDatum& datum() const { return datum_; }

 private:
  /// The used part of the file, in its posts. For a file around the whole earth, columns may lie
  /// before its first and beyond its last.
  struct Window {
    int column = 0;
    int row = 0;
    int columns = 0;
    int rows = 0;
  };

  Status find_window(const MapPlane& plane, const MapRect& area, const Georeference& place);
  Status find_conversion(GDALDataset& dataset,
                         const ElevationLayer& layer,
                         const Georeference& place,
                         std::vector<std::string>& warnings);
  [[nodiscard]] Result<HeightGrid> read_numbers(int column, int row, int columns, int rows) const;
  [[nodiscard]] double metres_of(float number) const;
  void to_metres(RawPosts& posts, int column, int row) const;
  /// Smallest and largest post (column, row) over an area of the map.
  [[nodiscard]] std::pair<Eigen::Vector2d, Eigen::Vector2d> post_bounds(const MapRect& area) const;
  void set_window(const Eigen::Vector2d& low, const Eigen::Vector2d& high);
  void page_posts(std::shared_ptr<BlockCache> cache);
  [[nodiscard]] Result<HeightGrid> posts_block(int column, int row) const;

  [[nodiscard]] std::string places_of(const MapPlane& plane,
                                      const MapRect& area,
                                      const Georeference& place) const;

  std::string file_;
  std::string whereabouts_;
  std::unique_ptr<DatasetPool> pool_;
  int step_ = 1;          ///< pixels of the file between two used posts
  int file_columns_ = 0;  ///< used posts of a row
  int file_rows_ = 0;
  std::optional<int> columns_around_;  ///< around the earth, if the file covers a full turn
  Window window_;
  std::optional<SmoothMap<2>> post_from_map_;
  double spacing_m_ = 0.0;
  double scale_m_ = 1.0;  ///< metres per unit of the raster
  double offset_m_ = 0.0;
  std::optional<double> nodata_;
  bool trusted_ = false;  ///< the manifest defines what is void; no other rule applies
  VoidRuns voids_;
  mutable std::atomic<bool> usual_void_seen_{false};
  std::shared_ptr<BlockCache> cache_;
  bool masked_ = false;  ///< a mask band marks the posts with data
  /// Of the file's overviews: false also if they may mix heights with voids that it does not
  /// declare.
  bool has_overviews_ = false;
  HeightGrid separation_m_;  ///< of the datum's zero, on a lattice over the window; may be empty
  std::string relation_;
  HeightDatum datum_;
  mutable std::atomic<bool> implausible_{false};
  std::unique_ptr<PagedHeights> posts_;
};

}  // namespace overfly::terrain
