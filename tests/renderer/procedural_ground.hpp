// A small analytic world for the renderer's tests: hills and a painted ground, without files.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "terrain/tile_source.hpp"

namespace overfly::testing {

/// Map plane = east and north of the world frame [m], moved by `map_offset_m`; the earth's
/// curvature is a paraboloid. Every texel of every level is the mean of the paint over 2 x 2
/// points of its square.
class ProceduralGround final : public terrain::TileSource {
 public:
  struct Options {
    int cols = 8;
    int rows = 8;
    double texel_m = 0.5;
    double map_offset_m = 4.0e5;  ///< map coordinates are large, as in real projections
    /// Height of the ground at (east, north) [m].
    std::function<double(double east_m, double north_m)> height_m = [](double, double) {
      return 0.0;
    };
    Eigen::Vector2d height_range_m{0.0, 0.0};
    /// Brightness at (east, north), in [0, 255].
    std::function<double(double east_m, double north_m)> paint;
    bool colourful = false;      ///< red and blue differ from the brightness
    int failing_level = -1;      ///< reading tiles of this level fails
    double centre_east_m = 0.0;  ///< where the imagery's middle lies
    bool curved = true;          ///< false: the earth is a plane
    double real_texel_m = 0.0;   ///< 0 = texel_m; finer levels than this are synthetic
    bool heights_fail = false;   ///< a height could not be read
  };

  explicit ProceduralGround(Options options);

  [[nodiscard]] double ground_up_m(double east_m, double north_m) const override;
  [[nodiscard]] const terrain::TileGrid& grid() const override { return grid_; }
  [[nodiscard]] double real_texel_m() const override {
    return options_.real_texel_m > 0.0 ? options_.real_texel_m : grid_.texel_m;
  }
  [[nodiscard]] terrain::TileCoverage coverage(const terrain::TileId& id) const override;
  [[nodiscard]] Result<terrain::Tile> read_tile(
      const terrain::TileId& id, const terrain::Cancelled& /*cancelled*/) const override;
  [[nodiscard]] Eigen::Vector3d world_from_map(double x_map_m, double y_map_m) const override;
  [[nodiscard]] Eigen::Vector2d map_from_world(double east_m, double north_m) const override;
  [[nodiscard]] bool has_imagery(double x_map_m, double y_map_m) const override;
  [[nodiscard]] const LocalFrame& frame() const override { return frame_; }
  [[nodiscard]] Eigen::Vector2d height_range_m() const override { return options_.height_range_m; }
  [[nodiscard]] std::string attribution() const override { return "painted by the test"; }
  [[nodiscard]] Status status() const override {
    if (!options_.heights_fail) return {};
    return Error{ErrorCode::kIo, "heights.tif: the disk is gone"};
  }

  /// Tiles read so far.
  [[nodiscard]] int tiles_read() const { return tiles_read_; }

 private:
  Options options_;
  terrain::TileGrid grid_;
  LocalFrame frame_;
  mutable std::atomic<int> tiles_read_{0};
};

/// Smooth structure at every scale from 1 m to 100 m, the same for the same place.
[[nodiscard]] double natural_paint(double east_m, double north_m);

/// Hills of 10 m over some 150 m and 30 m over some 900 m.
[[nodiscard]] double hills_m(double east_m, double north_m);

/// 2 x 2 km of natural paint over hills, the origin in its middle.
[[nodiscard]] std::shared_ptr<ProceduralGround> natural_ground();

}  // namespace overfly::testing
