// The ground as tiles of imagery over a map plane, and as a surface in the world frame.
//
// The map plane is a projected coordinate system in metres: x_map right (east), y_map up (north).
// It is that of the first imagery layer if that is metric and north-up (its texels are then used
// unchanged), else a transverse Mercator at the world's origin. Texels of level 0 have the size
// grid().texel_m, which doubles with each level. Tile (level, col, row) spans
//   x_map in [left_x_m + col * s, + s],  y_map in [top_y_m - (row + 1) * s, top_y_m - row * s],
//   s = kTileTexels * texel_m * 2^level.
// Columns and rows may be negative or beyond the imagery: such tiles have no imagery, and the
// ground there continues with the elevation's edge value.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/camera/image.hpp"
#include "core/earth/geodesy.hpp"
#include "core/earth/height_query.hpp"
#include "core/result.hpp"
#include "terrain/cancelled.hpp"

namespace overfly::terrain {

inline constexpr int kTileTexels = 512;  ///< side of a tile without its border
/// Texels of the neighbours around each tile, so that filtering is seamless down to mip 3.
inline constexpr int kTileBorder = 8;
/// Texels of a tile\'s side with its border.
inline constexpr int kTileSide = kTileTexels + 2 * kTileBorder;

/// Colour of the ground where there is no imagery.
inline constexpr std::uint8_t kVoidRgb[3] = {128, 128, 120};

struct TileId {
  int level = 0;
  int col = 0;
  int row = 0;
  // NOLINTNEXTLINE(modernize-use-nullptr): the check mistakes the generated comparison with 0.
  auto operator<=>(const TileId&) const = default;
};

struct TileGrid {
  double left_x_m = 0.0;  ///< map x of the imagery's left edge
  double top_y_m = 0.0;   ///< map y of the imagery's top edge
  double texel_m = 1.0;   ///< level 0
  int levels = 1;         ///< at level `levels - 1` one tile covers all imagery
  int cols = 1;           ///< tiles of level 0 that have imagery
  int rows = 1;
  double width_m = 0.0;   ///< of the imagery, from left_x_m; not a multiple of a tile
  double height_m = 0.0;  ///< of the imagery, down from top_y_m

  [[nodiscard]] double tile_m(int level) const { return kTileTexels * texel_m * (1 << level); }
};

enum class TileCoverage { kNone, kPartial, kFull };

/// One tile's texels: (kTileTexels + 2 kTileBorder)^2, row 0 in the north.
struct Tile {
  Image rgb;    ///< void texels have kVoidRgb
  Image valid;  ///< 255 = imagery, 0 = none
};

/// Thread-safe: the implementation guards its readers.
class TileSource : public HeightQuery {
 public:
  [[nodiscard]] virtual const TileGrid& grid() const = 0;
  /// Texel size of the photographed imagery [m]; coarser than grid().texel_m if finer levels are
  /// synthetic. Texels per pixel are counted in it.
  [[nodiscard]] virtual double real_texel_m() const { return grid().texel_m; }
  [[nodiscard]] virtual TileCoverage coverage(const TileId& id) const = 0;
  /// Reads a tile with its border. The first distant tile of a large image without overviews reads
  /// the whole image, which may take minutes.
  /// Errors: kIo when a file cannot be read; kCancelled.
  [[nodiscard]] Result<Tile> tile(const TileId& id, const Cancelled& cancelled = {}) const {
    return read_tile(id, cancelled);
  }

  /// The ground's point in the world frame above a place of the map plane [m].
  [[nodiscard]] virtual Eigen::Vector3d world_from_map(double x_map_m, double y_map_m) const = 0;
  /// As world_from_map, with elevation averaged to posts about `spacing_m` apart. Distant ground is
  /// drawn from it, so that a wide view needs little memory. Not finer than the elevation itself.
  [[nodiscard]] virtual Eigen::Vector3d coarse_world_from_map(double x_map_m,
                                                              double y_map_m,
                                                              double /*spacing_m*/) const {
    return world_from_map(x_map_m, y_map_m);
  }
  /// The same at several places, with equal results: places far outside the imagery take less time
  /// together.
  [[nodiscard]] virtual std::vector<Eigen::Vector3d> coarse_world_at(
      std::span<const Eigen::Vector2d> places_map_m, double spacing_m) const {
    std::vector<Eigen::Vector3d> points;
    points.reserve(places_map_m.size());
    for (const Eigen::Vector2d& place : places_map_m) {
      points.push_back(coarse_world_from_map(place.x(), place.y(), spacing_m));
    }
    return points;
  }
  /// The map position of the ground on the vertical world line through (east, north) [m].
  [[nodiscard]] virtual Eigen::Vector2d map_from_world(double east_m, double north_m) const = 0;
  /// True where there is imagery.
  [[nodiscard]] virtual bool has_imagery(double x_map_m, double y_map_m) const = 0;

  [[nodiscard]] virtual const LocalFrame& frame() const = 0;
  /// Lowest and highest ellipsoidal height of the ground [m].
  [[nodiscard]] virtual Eigen::Vector2d height_range_m() const = 0;
  /// Credit line of the imagery and elevation.
  [[nodiscard]] virtual std::string attribution() const = 0;
  /// kIo after a height could not be read (a truncated file, a removed disk), by any user of the
  /// world: height queries cannot report errors and return the lowest ground. Those of one's own
  /// queries: HeightErrors.
  [[nodiscard]] virtual Status status() const { return {}; }

 private:
  /// As tile.
  [[nodiscard]] virtual Result<Tile> read_tile(const TileId& id,
                                               const Cancelled& cancelled) const = 0;
};

}  // namespace overfly::terrain
