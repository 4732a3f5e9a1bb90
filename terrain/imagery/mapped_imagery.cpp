#include "terrain/imagery/mapped_imagery.hpp"

#include <algorithm>
#include <cmath>

#include "terrain/imagery/resample.hpp"
#include "terrain/raster/georeference.hpp"

namespace overfly::terrain {
namespace {

/// Margin of texels beyond the grid in which a warped layer must be transformable.
constexpr double kMarginTexels = 64.0;

MapRect extent_of(const TileGrid& grid) {
  const double coarsest = grid.tile_m(grid.levels - 1);
  const double width = std::max(coarsest, grid.cols * grid.tile_m(0));
  const double height = std::max(coarsest, grid.rows * grid.tile_m(0));
  return {grid.left_x_m, grid.top_y_m - height, grid.left_x_m + width, grid.top_y_m};
}

/// Size of a texel in file pixels at the map's middle, per file axis.
Eigen::Vector2d texel_size_px(const SmoothMap<2>& pixel_from_map, double texel_m) {
  const MapRect& area = pixel_from_map.domain();
  const double x = 0.5 * (area.x_min + area.x_max);
  const double y = 0.5 * (area.y_min + area.y_max);
  const Eigen::Vector2d here = pixel_from_map(x, y);
  const Eigen::Vector2d east = pixel_from_map(x + texel_m, y) - here;
  const Eigen::Vector2d north = pixel_from_map(x, y + texel_m) - here;
  // As long as the texel whatever way the file is turned.
  return (east.cwiseAbs2() + north.cwiseAbs2()).cwiseSqrt();
}

}  // namespace

MappedImagery MappedImagery::aligned(std::shared_ptr<const ImageryRaster> raster,
                                     const TileGrid& grid,
                                     int pad_x,
                                     int pad_y) {
  MappedImagery layer(std::move(raster), grid);
  layer.pad_x_ = pad_x;
  layer.pad_y_ = pad_y;
  return layer;
}

Result<MappedImagery> MappedImagery::warped(std::shared_ptr<const ImageryRaster> raster,
                                            const MapPlane& plane,
                                            const TileGrid& grid,
                                            const std::optional<Turn>& turn) {
  MappedImagery layer(std::move(raster), grid);
  const Georeference& place = layer.raster_->georeference();
  const std::string file = layer.raster_->file().string();
  auto transform = CrsTransform::create(wgs84_crs(), place.crs, file);
  if (!transform) return transform.error();
  const PlaneFunction exact = [&](const Eigen::Matrix2Xd& points, Eigen::MatrixXd& values) {
    Eigen::Matrix2Xd crs_points = points;
    if (!plane.to_crs(**transform, crs_points)) return false;
    values.resize(2, points.cols());
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      if (turn) turn->apply(crs_points(0, i));
      place.transform.pixel_from_crs(
          crs_points(0, i), crs_points(1, i), values(0, i), values(1, i));
    }
    return true;
  };
  const double margin = kMarginTexels * grid.texel_m * (1 << (grid.levels - 1));
  constexpr double kTolerancePx = 0.01;
  layer.pixel_from_map_ = SmoothMap<2>::fit(extent_of(grid).grown(margin), exact, kTolerancePx);
  if (!layer.pixel_from_map_) {
    return Error{ErrorCode::kInvalidArgument,
                 file +
                     ": its coordinate reference system has no smooth relation to the map "
                     "plane over the imagery"};
  }
  layer.texel_px_ = texel_size_px(*layer.pixel_from_map_, grid.texel_m);
  return layer;
}

Result<std::vector<std::optional<Turn>>> MappedImagery::turns_over_grid(const ImageryRaster& raster,
                                                                        const MapPlane& plane,
                                                                        const TileGrid& grid) {
  return turns_over(plane,
                    extent_of(grid),
                    raster.georeference(),
                    raster.width_px(),
                    raster.height_px(),
                    raster.file().string());
}

Status MappedImagery::find_validity(std::optional<ValidityGrid> known, const Cancelled& cancelled) {
  validity_ = std::move(known);
  if (!raster_->has_mask() || validity_) return {};
  auto validity = ValidityGrid::read(*raster_, cancelled);
  if (!validity) return validity.error();
  validity_ = std::move(*validity);
  return {};
}

std::string MappedImagery::fingerprint() const {
  std::string text =
      pixel_from_map_ ? "texels " + pixel_from_map_->fingerprint() : "texels of the grid";
  if (const RasterBands& bands = raster_->bands(); bands.rescaled) {
    text += ", values " + std::to_string(bands.low) + " to " + std::to_string(bands.high);
  }
  return text;
}

Eigen::Vector2d MappedImagery::pixel_from_map(double x_map_m, double y_map_m) const {
  if (pixel_from_map_) return (*pixel_from_map_)(x_map_m, y_map_m);
  return {(x_map_m - grid_.left_x_m) / grid_.texel_m - pad_x_,
          (grid_.top_y_m - y_map_m) / grid_.texel_m - pad_y_};
}

Result<Patch> MappedImagery::read(const TileId& id, const Cancelled& cancelled) const {
  if (pixel_from_map_) return read_warped(id, cancelled);
  return raster_->read(id.level,
                       id.col * kTileTexels - kTileBorder - (pad_x_ >> id.level),
                       id.row * kTileTexels - kTileBorder - (pad_y_ >> id.level),
                       kTileSide,
                       kTileSide,
                       cancelled);
}

Result<Patch> MappedImagery::read_warped(const TileId& id, const Cancelled& cancelled) const {
  const double texel_m = grid_.texel_m * (1 << id.level);
  const double left_x_m = grid_.left_x_m + (id.col * kTileTexels - kTileBorder) * texel_m;
  const double top_y_m = grid_.top_y_m - (id.row * kTileTexels - kTileBorder) * texel_m;
  const MapRect covered{
      left_x_m, top_y_m - kTileSide * texel_m, left_x_m + kTileSide * texel_m, top_y_m};
  const MapRect& known = pixel_from_map_->domain();
  if (covered.x_max < known.x_min || covered.x_min > known.x_max || covered.y_max < known.y_min ||
      covered.y_min > known.y_max) {
    return void_patch(kTileSide, kTileSide);
  }
  Eigen::Matrix2Xd pixels(2, kTileSide * kTileSide);
  for (int v = 0; v < kTileSide; ++v) {
    const double y_map_m = top_y_m - (v + 0.5) * texel_m;
    for (int u = 0; u < kTileSide; ++u) {
      const double x_map_m = left_x_m + (u + 0.5) * texel_m;
      Eigen::Vector2d pixel(-1e9, -1e9);
      if (known.contains(x_map_m, y_map_m)) pixel = (*pixel_from_map_)(x_map_m, y_map_m);
      pixels.col(static_cast<Eigen::Index>(v) * kTileSide + u) = pixel;
    }
  }
  return resample(*raster_, pixels, texel_px_, id.level, kTileSide, kTileSide, cancelled);
}

TileCoverage MappedImagery::coverage(const TileId& id) const {
  const double side_m = grid_.tile_m(id.level);
  const double left = grid_.left_x_m + id.col * side_m;
  const double top = grid_.top_y_m - id.row * side_m;
  const int steps = pixel_from_map_ ? 8 : 1;
  Eigen::Vector2d low(1e18, 1e18);
  Eigen::Vector2d high(-1e18, -1e18);
  for (int j = 0; j <= steps; ++j) {
    for (int i = 0; i <= steps; ++i) {
      double x = left + side_m * i / steps;
      double y = top - side_m * j / steps;
      if (pixel_from_map_) {
        const MapRect& known = pixel_from_map_->domain();
        x = std::clamp(x, known.x_min, known.x_max);
        y = std::clamp(y, known.y_min, known.y_max);
      }
      const Eigen::Vector2d pixel = pixel_from_map(x, y);
      low = low.cwiseMin(pixel);
      high = high.cwiseMax(pixel);
    }
  }
  const int width = raster_->width_px();
  const int height = raster_->height_px();
  if (low.x() >= width || low.y() >= height || high.x() <= 0.0 || high.y() <= 0.0) {
    return TileCoverage::kNone;
  }
  if (validity_) {
    return validity_->coverage(low.x(), low.y(), high.x(), high.y());
  }
  // A warped tile's bounding box shows only that there may be void corners.
  const double slack = pixel_from_map_ ? 1.0 : -1e-6;
  const bool inside = low.x() >= slack && low.y() >= slack && high.x() <= width - slack &&
                      high.y() <= height - slack;
  return inside ? TileCoverage::kFull : TileCoverage::kPartial;
}

bool MappedImagery::has_imagery(double x_map_m, double y_map_m) const {
  if (pixel_from_map_ && !pixel_from_map_->domain().contains(x_map_m, y_map_m)) return false;
  const Eigen::Vector2d pixel = pixel_from_map(x_map_m, y_map_m);
  if (validity_) return validity_->valid_at(pixel.x(), pixel.y());
  return pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() < raster_->width_px() &&
         pixel.y() < raster_->height_px();
}

}  // namespace overfly::terrain
