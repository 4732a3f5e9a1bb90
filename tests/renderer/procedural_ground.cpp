#include "tests/renderer/procedural_ground.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace overfly::testing {

using terrain::TileCoverage;
using terrain::TileId;

namespace {

constexpr double kEarthRadiusM = 6371000.0;

/// A hash of a lattice point, in [0, 1).
double lattice(std::int64_t x, std::int64_t y, std::uint64_t octave) {
  std::uint64_t h = static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15ULL +
                    static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4FULL + octave;
  h = (h ^ (h >> 31U)) * 0xBF58476D1CE4E5B9ULL;
  h = (h ^ (h >> 27U)) * 0x94D049BB133111EBULL;
  return static_cast<double>((h ^ (h >> 31U)) >> 11U) * 0x1.0p-53;
}

constexpr std::size_t kOctaves = 7;

/// The values of `lattice` around the last place of an octave: the next place is often in the same
/// square.
struct LatticeSquare {
  std::int64_t x = std::numeric_limits<std::int64_t>::max();
  std::int64_t y = 0;
  double at[2][2] = {};  ///< [y][x]
};

double smooth_noise(double x, double y, std::uint64_t octave, LatticeSquare& square) {
  const auto below = [](double v) {
    const auto truncated = static_cast<std::int64_t>(v);
    return truncated - (static_cast<double>(truncated) > v ? 1 : 0);
  };
  const std::int64_t fx = below(x);
  const std::int64_t fy = below(y);
  if (fx != square.x || fy != square.y) {
    square.x = fx;
    square.y = fy;
    for (const int dy : {0, 1}) {
      for (const int dx : {0, 1}) square.at[dy][dx] = lattice(fx + dx, fy + dy, octave);
    }
  }
  const auto ease = [](double t) { return t * t * (3.0 - 2.0 * t); };
  const double a = ease(x - static_cast<double>(fx));
  const double b = ease(y - static_cast<double>(fy));
  const auto& at = square.at;
  return (1 - b) * ((1 - a) * at[0][0] + a * at[0][1]) + b * ((1 - a) * at[1][0] + a * at[1][1]);
}

}  // namespace

double natural_paint(double east_m, double north_m) {
  thread_local std::array<LatticeSquare, kOctaves> squares;
  double sum = 0.0;
  double amplitude = 60.0;
  double x = east_m / 96.0;  // in wavelengths of the octave
  double y = north_m / 96.0;
  for (std::size_t octave = 0; octave < kOctaves; ++octave) {
    sum += amplitude * (smooth_noise(x, y, octave, squares[octave]) - 0.5);
    amplitude *= 0.75;
    x *= 2.0;
    y *= 2.0;
  }
  return std::clamp(120.0 + sum, 0.0, 255.0);
}

double hills_m(double east_m, double north_m) {
  return 5.0 * std::sin(east_m / 24.0) * std::cos(north_m / 31.0) +
         15.0 * std::sin(east_m / 140.0 + 1.0) * std::sin(north_m / 170.0);
}

std::shared_ptr<ProceduralGround> natural_ground() {
  ProceduralGround::Options options;
  options.height_m = hills_m;
  options.height_range_m = {-20.0, 20.0};
  options.paint = natural_paint;
  options.colourful = true;
  return std::make_shared<ProceduralGround>(options);
}

ProceduralGround::ProceduralGround(Options options)
    : options_(std::move(options)), frame_(geodetic_from_deg(39.35, -86.04, 0.0)) {
  grid_.texel_m = options_.texel_m;
  grid_.cols = options_.cols;
  grid_.rows = options_.rows;
  grid_.left_x_m =
      options_.map_offset_m + options_.centre_east_m - 0.5 * options_.cols * grid_.tile_m(0);
  grid_.top_y_m = options_.map_offset_m + 0.5 * options_.rows * grid_.tile_m(0);
  grid_.width_m = grid_.cols * grid_.tile_m(0);
  grid_.height_m = grid_.rows * grid_.tile_m(0);
  grid_.levels = 1;
  while ((1 << (grid_.levels - 1)) < std::max(options_.cols, options_.rows)) ++grid_.levels;
}

double ProceduralGround::ground_up_m(double east_m, double north_m) const {
  if (!options_.curved) return options_.height_m(east_m, north_m);
  return options_.height_m(east_m, north_m) -
         (east_m * east_m + north_m * north_m) / (2.0 * kEarthRadiusM);
}

TileCoverage ProceduralGround::coverage(const TileId& id) const {
  const int span = 1 << id.level;
  const auto share = [span](int index, int count) {
    const int first = std::max(index * span, 0);
    const int last = std::min((index + 1) * span, count);
    return std::max(last - first, 0);
  };
  const int cols = share(id.col, grid_.cols);
  const int rows = share(id.row, grid_.rows);
  if (cols == 0 || rows == 0) return TileCoverage::kNone;
  return cols == span && rows == span ? TileCoverage::kFull : TileCoverage::kPartial;
}

Result<terrain::Tile> ProceduralGround::read_tile(const TileId& id,
                                                  const terrain::Cancelled& /*cancelled*/) const {
  if (id.level == options_.failing_level) {
    return Error{ErrorCode::kIo, "painted.tif: the disk is gone"};
  }
  ++tiles_read_;
  terrain::Tile tile{Image(terrain::kTileSide, terrain::kTileSide, 3),
                     Image(terrain::kTileSide, terrain::kTileSide, 1)};
  const double texel_m = std::ldexp(grid_.texel_m, id.level);
  for (int row = 0; row < terrain::kTileSide; ++row) {
    for (int column = 0; column < terrain::kTileSide; ++column) {
      const double x_m = grid_.left_x_m + id.col * grid_.tile_m(id.level) +
                         (column - terrain::kTileBorder + 0.5) * texel_m;
      const double y_m = grid_.top_y_m - id.row * grid_.tile_m(id.level) -
                         (row - terrain::kTileBorder + 0.5) * texel_m;
      const bool valid = has_imagery(x_m, y_m);
      tile.valid.at(column, row) = valid ? 255 : 0;
      double sum = 0.0;
      for (const double dx : {-0.25, 0.25}) {
        for (const double dy : {-0.25, 0.25}) {
          sum += options_.paint(x_m + dx * texel_m - options_.map_offset_m,
                                y_m + dy * texel_m - options_.map_offset_m);
        }
      }
      const double value = 0.25 * sum;
      const double tint = options_.colourful ? 0.8 : 1.0;
      for (int c = 0; c < 3; ++c) {
        const double painted = c == 1 ? value : tint * value;
        tile.rgb.at(column, row, c) =
            valid ? static_cast<std::uint8_t>(painted + 0.5) : terrain::kVoidRgb[c];
      }
    }
  }
  return tile;
}

Eigen::Vector3d ProceduralGround::world_from_map(double x_map_m, double y_map_m) const {
  const double east_m = x_map_m - options_.map_offset_m;
  const double north_m = y_map_m - options_.map_offset_m;
  return {east_m, north_m, ground_up_m(east_m, north_m)};
}

Eigen::Vector2d ProceduralGround::map_from_world(double east_m, double north_m) const {
  return {east_m + options_.map_offset_m, north_m + options_.map_offset_m};
}

bool ProceduralGround::has_imagery(double x_map_m, double y_map_m) const {
  return x_map_m >= grid_.left_x_m && y_map_m <= grid_.top_y_m &&
         x_map_m < grid_.left_x_m + grid_.cols * grid_.tile_m(0) &&
         y_map_m > grid_.top_y_m - grid_.rows * grid_.tile_m(0);
}

}  // namespace overfly::testing
