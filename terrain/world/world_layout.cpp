#include "terrain/world/world_layout.hpp"

#include <algorithm>
#include <cmath>

#include "core/motion/pose.hpp"
#include "terrain/raster/georeference.hpp"

namespace overfly::terrain {
namespace {

/// Points along a file's border and inside it, converted from file pixels to longitude and latitude
/// [rad], without a jump at the antimeridian.
Result<Eigen::Matrix2Xd> geodetic_outline(const ImageryRaster& raster) {
  const Georeference& place = raster.georeference();
  auto transform = CrsTransform::create(place.crs, wgs84_crs(), raster.file().string());
  if (!transform) return transform.error();
  constexpr int kSteps = 16;
  Eigen::Matrix2Xd points(2, (kSteps + 1) * (kSteps + 1));
  for (int j = 0; j <= kSteps; ++j) {
    for (int i = 0; i <= kSteps; ++i) {
      const Eigen::Index at = j * (kSteps + 1) + i;
      place.transform.crs_from_pixel(static_cast<double>(raster.width_px()) * i / kSteps,
                                     static_cast<double>(raster.height_px()) * j / kSteps,
                                     points(0, at),
                                     points(1, at));
    }
  }
  if (!(*transform)->apply(points)) {
    return Error{ErrorCode::kInvalidArgument,
                 raster.file().string() +
                     ": part of it has no latitude and longitude: its georeference is broken"};
  }
  for (Eigen::Index i = 1; i < points.cols(); ++i) {
    points(0, i) = unwrapped(points(0, i), points(0, 0), 360.0);
  }
  return Eigen::Matrix2Xd(points * rad_from_deg(1.0));
}

/// Sizes of a texel on the ground at the file's centre [m], along its columns and rows.
Result<Eigen::Vector2d> texel_on_ground(const ImageryRaster& raster) {
  const Georeference& place = raster.georeference();
  auto transform = CrsTransform::create(place.crs, wgs84_crs(), raster.file().string());
  if (!transform) return transform.error();
  constexpr double kSpanPx = 16.0;
  Eigen::Matrix2Xd points(2, 3);
  const double px = 0.5 * raster.width_px();
  const double py = 0.5 * raster.height_px();
  place.transform.crs_from_pixel(px, py, points(0, 0), points(1, 0));
  place.transform.crs_from_pixel(px + kSpanPx, py, points(0, 1), points(1, 1));
  place.transform.crs_from_pixel(px, py + kSpanPx, points(0, 2), points(1, 2));
  if (!(*transform)->apply(points)) {
    return Error{ErrorCode::kInvalidArgument,
                 raster.file().string() + ": its middle has no latitude and longitude"};
  }
  points *= rad_from_deg(1.0);
  const auto ecef = [&](int i) { return ecef_from_geodetic({points(1, i), points(0, i), 0.0}); };
  return Eigen::Vector2d((ecef(1) - ecef(0)).norm() / kSpanPx,
                         (ecef(2) - ecef(0)).norm() / kSpanPx);
}

MapRect bounds_of(const Eigen::Matrix2Xd& points) {
  return {points.row(0).minCoeff(),
          points.row(1).minCoeff(),
          points.row(0).maxCoeff(),
          points.row(1).maxCoeff()};
}

/// The plane and the texel size; sets `first_aligned`.
Status choose_plane(const ImageryRaster& first,
                    const std::optional<Geodetic>& origin,
                    WorldLayout& layout) {
  const Georeference& place = first.georeference();
  const std::string file = first.file().string();
  auto ground = texel_on_ground(first);
  if (!ground) return ground.error();
  const double aspect = ground->x() / ground->y();
  constexpr double kTolerance = 0.01;
  if (place.crs.IsProjected() != 0 && place.transform.north_up() &&
      std::abs(aspect - 1.0) < kTolerance) {
    const double width = place.transform.g[1];
    const double height = -place.transform.g[5];
    const double unit_m = place.crs.GetLinearUnits();
    // A projection that is not true to scale at this place (Web Mercator) is scaled to the ground.
    const bool true_scale = std::abs(ground->x() / (width * unit_m) - 1.0) < kTolerance;
    layout.first_aligned = true;
    layout.grid.texel_m = true_scale ? width * unit_m : ground->x();
    auto plane = MapPlane::create(place.crs,
                                  layout.grid.texel_m / width,
                                  layout.grid.texel_m / height,
                                  place.transform.g[0] + 0.5 * width * first.width_px(),
                                  file);
    if (!plane) return plane.error();
    layout.plane = std::move(*plane);
    return {};
  }
  auto outline = geodetic_outline(first);
  if (!outline) return outline.error();
  const MapRect bounds = bounds_of(*outline);
  const double lat_rad = origin ? origin->lat_rad : 0.5 * (bounds.y_min + bounds.y_max);
  const double lon_rad = origin ? origin->lon_rad : 0.5 * (bounds.x_min + bounds.x_max);
  auto plane = MapPlane::create(transverse_mercator_at(lat_rad, lon_rad), 1.0, 1.0, 0.0, file);
  if (!plane) return plane.error();
  layout.plane = std::move(*plane);
  layout.grid.texel_m = ground->minCoeff();
  return {};
}

/// Rounds up to texels of the coarsest level, so that every level's texels begin at the grid's.
int padded(double texels, int levels) {
  const int step = 1 << levels;
  return texels <= 1e-6 ? 0 : static_cast<int>(std::ceil(texels / step)) * step;
}

}  // namespace

Result<WorldLayout> lay_out_world(const std::vector<std::shared_ptr<const ImageryRaster>>& rasters,
                                  const std::optional<Geodetic>& origin) {
  WorldLayout layout;
  const ImageryRaster& first = *rasters.front();
  const Status chosen = choose_plane(first, origin, layout);
  if (!chosen) return chosen.error();

  for (std::size_t i = 0; i < rasters.size(); ++i) {
    auto outline = geodetic_outline(*rasters[i]);
    if (!outline) return outline.error();
    if (!layout.plane.map_from_geodetic(*outline)) {
      return Error{
          ErrorCode::kInvalidArgument,
          rasters[i]->file().string() + ": has no place on the map of " + first.file().string()};
    }
    const MapRect bounds = bounds_of(*outline);
    MapRect& all = layout.extent;
    all = i == 0 ? bounds
                 : MapRect{std::min(all.x_min, bounds.x_min),
                           std::min(all.y_min, bounds.y_min),
                           std::max(all.x_max, bounds.x_max),
                           std::max(all.y_max, bounds.y_max)};
    constexpr double kFarthestM = 500e3;
    if (all.x_max - all.x_min > kFarthestM || all.y_max - all.y_min > kFarthestM) {
      return Error{ErrorCode::kInvalidArgument,
                   rasters[i]->file().string() + ": imagery spans " +
                       std::to_string(static_cast<int>((all.x_max - all.x_min) / 1000.0)) + " x " +
                       std::to_string(static_cast<int>((all.y_max - all.y_min) / 1000.0)) +
                       " km, limit 500 km"};
    }
  }

  TileGrid& grid = layout.grid;
  const MapRect& all = layout.extent;
  const auto tiles = [&](double length_m) {
    constexpr double kHair = 1e-6;
    return std::max(1, static_cast<int>(std::ceil(length_m / grid.tile_m(0) - kHair)));
  };
  grid.cols = tiles(all.x_max - all.x_min);
  grid.rows = tiles(all.y_max - all.y_min);
  for (grid.levels = 1; (1 << (grid.levels - 1)) < std::max(grid.cols, grid.rows);) ++grid.levels;
  grid.left_x_m = all.x_min;
  grid.top_y_m = all.y_max;
  if (layout.first_aligned) {
    const double* g = first.georeference().transform.g;
    const double left = g[0] * layout.plane.scale_x();
    const double top = g[3] * layout.plane.scale_y();
    layout.pad_x = padded((left - all.x_min) / grid.texel_m, grid.levels);
    layout.pad_y = padded((all.y_max - top) / grid.texel_m, grid.levels);
    grid.left_x_m = left - layout.pad_x * grid.texel_m;
    grid.top_y_m = top + layout.pad_y * grid.texel_m;
    grid.cols = tiles(all.x_max - grid.left_x_m);
    grid.rows = tiles(grid.top_y_m - all.y_min);
    while ((1 << (grid.levels - 1)) < std::max(grid.cols, grid.rows)) ++grid.levels;
  }
  grid.width_m = all.x_max - grid.left_x_m;
  grid.height_m = grid.top_y_m - all.y_min;
  Eigen::Matrix2Xd middle(2, 1);
  middle << 0.5 * (all.x_min + all.x_max), 0.5 * (all.y_min + all.y_max);
  if (!layout.plane.geodetic_from_map(middle)) {
    return Error{ErrorCode::kInvalidArgument,
                 first.file().string() + ": the imagery's middle has no place in WGS84"};
  }
  layout.center_lon_rad = middle(0, 0);
  layout.center_lat_rad = middle(1, 0);
  return layout;
}

}  // namespace overfly::terrain
