#include "server/maps/map_tile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "server/maps/ground_place.hpp"
#include "terrain/height_errors.hpp"

namespace overfly::server {
namespace {

using terrain::TileId;

constexpr int kNodeStepPx = 16;
constexpr int kSamplesPerSide = 2;
constexpr int kFinestLevelMax = 23;  // of tiles that can be read

/// Pixels of the tile in which there may be imagery.
struct PixelRange {
  int left = 0;
  int top = 0;
  int right = 0;   // not part of it
  int bottom = 0;  // not part of it
};

/// A tile's pixels in the web Mercator square.
struct TilePlane {
  explicit TilePlane(const MapTileId& id)
      : scale(1.0 / (static_cast<double>(kMapTilePx) * std::ldexp(1.0, id.zoom))),
        corner(std::ldexp(id.x, -id.zoom), std::ldexp(id.y, -id.zoom)) {}

  /// @param x_px, y_px  from the tile's north-west corner; pixel centres are at halves
  [[nodiscard]] Eigen::Vector2d place(double x_px, double y_px) const {
    return corner + scale * Eigen::Vector2d(x_px, y_px);
  }
  double scale;  ///< of a pixel
  Eigen::Vector2d corner;
};

PixelRange tile_range(const TilePlane& plane, const MercatorBox& box) {
  const auto pixels = [&](double low, double high, double corner, int& first, int& end) {
    const auto inside = [](double px) {
      return static_cast<int>(std::clamp(px, 0.0, static_cast<double>(kMapTilePx)));
    };
    first = inside(std::floor((low - corner) / plane.scale));
    end = inside(std::ceil((high - corner) / plane.scale));
  };
  PixelRange range;
  pixels(box.low.x(), box.high.x(), plane.corner.x(), range.left, range.right);
  pixels(box.low.y(), box.high.y(), plane.corner.y(), range.top, range.bottom);
  return range;
}

/// Places on the world's map plane of nodes over a range of pixels.
class NodeGrid {
 public:
  NodeGrid(const terrain::TileSource& tiles, const TilePlane& plane, const PixelRange& range)
      : range_(range),
        cols_((range.right - range.left + kNodeStepPx - 1) / kNodeStepPx + 1),
        rows_((range.bottom - range.top + kNodeStepPx - 1) / kNodeStepPx + 1) {
    double alt_m = tiles.frame().origin().alt_ellipsoid_m;
    nodes_.reserve(static_cast<std::size_t>(cols_) * rows_);
    for (int row = 0; row < rows_; ++row) {
      for (int col = 0; col < cols_; ++col) {
        Geodetic place = geodetic_from_mercator(
            plane.place(range.left + col * kNodeStepPx, range.top + row * kNodeStepPx));
        place.alt_ellipsoid_m = alt_m;
        const GroundPlace ground = ground_at(tiles, place);
        alt_m = ground.alt_ellipsoid_m;
        nodes_.push_back(ground.map_m);
      }
    }
  }

  [[nodiscard]] Eigen::Vector2d at(double x_px, double y_px) const {
    const double u = (x_px - range_.left) / kNodeStepPx;
    const double v = (y_px - range_.top) / kNodeStepPx;
    const int col = std::clamp(static_cast<int>(u), 0, cols_ - 2);
    const int row = std::clamp(static_cast<int>(v), 0, rows_ - 2);
    const double a = u - col;
    const double b = v - row;
    return (1.0 - b) * ((1.0 - a) * node(col, row) + a * node(col + 1, row)) +
           b * ((1.0 - a) * node(col, row + 1) + a * node(col + 1, row + 1));
  }
  /// Map metres of a pixel in the middle.
  [[nodiscard]] double pixel_m() const {
    const int col = (cols_ - 1) / 2;
    const int row = (rows_ - 1) / 2;
    const double across = (node(std::min(col + 1, cols_ - 1), row) - node(col, row)).norm();
    const double down = (node(col, std::min(row + 1, rows_ - 1)) - node(col, row)).norm();
    return std::max(across, down) / kNodeStepPx;
  }

 private:
  [[nodiscard]] const Eigen::Vector2d& node(int col, int row) const {
    return nodes_[static_cast<std::size_t>(row) * cols_ + col];
  }
  PixelRange range_;
  int cols_;
  int rows_;
  std::vector<Eigen::Vector2d> nodes_;
};

/// Sum of samples, weighted by their opacity.
struct Blend {
  std::array<double, 3> rgb{};
  double weight = 0.0;
};

/// Reads texels of one level.
class LevelSampler {
 public:
  LevelSampler(const MapWorld& world, int level, const terrain::Cancelled& cancelled)
      : world_(world),
        level_(level),
        texel_m_(world.tiles().grid().texel_m * std::ldexp(1.0, level)),
        cancelled_(cancelled) {}

  /// Bilinear, of the texels with imagery.
  Status add(const Eigen::Vector2d& map_m, Blend& blend) {
    const terrain::TileGrid& grid = world_.tiles().grid();
    const double u = (map_m.x() - grid.left_x_m) / texel_m_;
    const double v = (grid.top_y_m - map_m.y()) / texel_m_;
    constexpr double kFar = 1e9;  // no such tile exists
    if (!(std::abs(u) < kFar && std::abs(v) < kFar)) return {};
    const TileId id{level_,
                    static_cast<int>(std::floor(u / terrain::kTileTexels)),
                    static_cast<int>(std::floor(v / terrain::kTileTexels))};
    if (Status status = hold(id); !status) return status;
    if (tile_ == nullptr) return {};
    // Centres of texels are at halves.
    const double x = u - static_cast<double>(id.col) * terrain::kTileTexels - 0.5;
    const double y = v - static_cast<double>(id.row) * terrain::kTileTexels - 0.5;
    const int left = static_cast<int>(std::floor(x));
    const int top = static_cast<int>(std::floor(y));
    const double a = x - left;
    const double b = y - top;
    add_texel(left, top, (1.0 - a) * (1.0 - b), blend);
    add_texel(left + 1, top, a * (1.0 - b), blend);
    add_texel(left, top + 1, (1.0 - a) * b, blend);
    add_texel(left + 1, top + 1, a * b, blend);
    return {};
  }

 private:
  Status hold(const TileId& id) {
    if (held_ && id_ == id) return {};
    id_ = id;
    held_ = true;
    tile_ = nullptr;
    if (world_.tiles().coverage(id) == terrain::TileCoverage::kNone) return {};
    auto tile = world_.tile(id, cancelled_);
    if (!tile) return tile.error();
    tile_ = std::move(*tile);
    return {};
  }
  void add_texel(int x, int y, double weight, Blend& blend) const {
    x += terrain::kTileBorder;
    y += terrain::kTileBorder;
    if (tile_->valid.at(x, y) == 0) return;
    for (int c = 0; c < 3; ++c) {
      blend.rgb[static_cast<std::size_t>(c)] += weight * tile_->rgb.at(x, y, c);
    }
    blend.weight += weight;
  }

  const MapWorld& world_;
  int level_;
  double texel_m_;
  const terrain::Cancelled& cancelled_;
  bool held_ = false;
  TileId id_;
  std::shared_ptr<const terrain::Tile> tile_;  ///< null: no imagery
};

int level_for(double pixel_m, double texel_m) {
  if (!(pixel_m > texel_m)) return 0;
  return std::min(static_cast<int>(std::log2(pixel_m / texel_m)), kFinestLevelMax);
}

void put_pixel(const Blend& blend, int samples, int x, int y, Image& image) {
  if (blend.weight <= 0.0) return;
  for (int c = 0; c < 3; ++c) {
    image.at(x, y, c) = static_cast<std::uint8_t>(
        std::lround(blend.rgb[static_cast<std::size_t>(c)] / blend.weight));
  }
  image.at(x, y, 3) =
      static_cast<std::uint8_t>(std::lround(255.0 * std::min(1.0, blend.weight / samples)));
}

}  // namespace

Result<Image> draw_map_tile(const MapWorld& world,
                            const MapTileId& id,
                            const terrain::Cancelled& cancelled) {
  TilePlane plane(id);
  // The copy of the map in which the world lies.
  const double middle_x = 0.5 * (world.box().low.x() + world.box().high.x());
  plane.corner.x() += std::round(middle_x - plane.place(0.5 * kMapTilePx, 0.0).x());
  const PixelRange range = tile_range(plane, world.box());
  if (range.left >= range.right || range.top >= range.bottom) return Image();
  const terrain::HeightErrors errors;
  const NodeGrid nodes(world.tiles(), plane, range);
  if (Status read = errors.status(); !read) return read.error();
  LevelSampler sampler(world, level_for(nodes.pixel_m(), world.tiles().grid().texel_m), cancelled);
  Image image(kMapTilePx, kMapTilePx, 4);
  bool any = false;
  for (int y = range.top; y < range.bottom; ++y) {
    if (cancelled && cancelled()) return Error{ErrorCode::kCancelled, "the map was cancelled"};
    for (int x = range.left; x < range.right; ++x) {
      Blend blend;
      for (int sample = 0; sample < kSamplesPerSide * kSamplesPerSide; ++sample) {
        const double right = (sample % kSamplesPerSide + 0.5) / kSamplesPerSide;
        const double down = (sample / kSamplesPerSide + 0.5) / kSamplesPerSide;
        if (Status status = sampler.add(nodes.at(x + right, y + down), blend); !status) {
          return status.error();
        }
      }
      put_pixel(blend, kSamplesPerSide * kSamplesPerSide, x, y, image);
      any = any || blend.weight > 0.0;
    }
  }
  return any ? std::move(image) : Image();
}

}  // namespace overfly::server
