#include "terrain/world/raster_world.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cstddef>
#include <cstdio>

namespace overfly::terrain {

Result<MapGeodesy> MapGeodesy::create(const MapPlane& plane,
                                      const LocalFrame& frame,
                                      const MapRect& domain) {
  MapGeodesy geodesy;
  geodesy.plane_ = plane;
  geodesy.frame_ = frame;
  const PlaneFunction exact = [&](const Eigen::Matrix2Xd& points, Eigen::MatrixXd& values) {
    Eigen::Matrix2Xd lon_lat = points;
    if (!plane.geodetic_from_map(lon_lat)) return false;
    values.resize(6, points.cols());
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      const Eigen::Vector3d foot = frame.world_from_geodetic({lon_lat(1, i), lon_lat(0, i), 0.0});
      // Length along the ellipsoid's normal, large enough for full precision.
      constexpr double kLengthM = 1000.0;
      const Eigen::Vector3d above =
          frame.world_from_geodetic({lon_lat(1, i), lon_lat(0, i), kLengthM});
      values.col(i) << foot, (above - foot) / kLengthM;
    }
    return true;
  };
  constexpr double kToleranceM = 1e-4;
  geodesy.ground_ = Ground::fit(domain, exact, kToleranceM);
  if (!geodesy.ground_) {
    return Error{ErrorCode::kInvalidArgument,
                 "the imagery's coordinate reference system has no smooth relation to WGS84 "
                 "around the imagery"};
  }
  geodesy.middle_map_m_ = {0.5 * (domain.x_min + domain.x_max),
                           0.5 * (domain.y_min + domain.y_max)};
  const Eigen::Vector2d middle = geodesy.middle_map_m_;
  const double height_m = frame.origin().alt_ellipsoid_m;
  constexpr double kStepM = 100.0;
  geodesy.middle_world_m_ = geodesy.world(middle.x(), middle.y(), height_m).head<2>();
  Eigen::Matrix2d world_per_map;
  world_per_map.col(0) = (geodesy.world(middle.x() + kStepM, middle.y(), height_m) -
                          geodesy.world(middle.x() - kStepM, middle.y(), height_m))
                             .head<2>() /
                         (2.0 * kStepM);
  world_per_map.col(1) = (geodesy.world(middle.x(), middle.y() + kStepM, height_m) -
                          geodesy.world(middle.x(), middle.y() - kStepM, height_m))
                             .head<2>() /
                         (2.0 * kStepM);
  geodesy.map_per_world_ = world_per_map.inverse();
  return geodesy;
}

MapGeodesy::Ground::Value MapGeodesy::ground(double x_map_m, double y_map_m) const {
  const MapRect& known = ground_->domain();
  if (known.contains(x_map_m, y_map_m)) return (*ground_)(x_map_m, y_map_m);
  Eigen::Matrix2Xd point(2, 1);
  point << x_map_m, y_map_m;
  if (plane_.geodetic_from_map(point)) return ground_from_geodetic(point(1, 0), point(0, 0));
  // Beyond the projection's range there is no correct answer: the nearest known place is used.
  return (*ground_)(std::clamp(x_map_m, known.x_min, known.x_max),
                    std::clamp(y_map_m, known.y_min, known.y_max));
}

MapGeodesy::Ground::Value MapGeodesy::ground_from_geodetic(double lat_rad, double lon_rad) const {
  Ground::Value value;
  const Eigen::Vector3d foot = frame_->world_from_geodetic({lat_rad, lon_rad, 0.0});
  value << foot, frame_->world_from_geodetic({lat_rad, lon_rad, 1.0}) - foot;
  return value;
}

Eigen::Vector3d MapGeodesy::world(double x_map_m, double y_map_m, double height_m) const {
  const Ground::Value value = ground(x_map_m, y_map_m);
  return value.head<3>() + height_m * value.tail<3>();
}

std::vector<Eigen::Vector3d> MapGeodesy::world(std::span<const Eigen::Vector2d> places_map_m,
                                               std::span<const double> heights_m) const {
  std::vector<Ground::Value> grounds(places_map_m.size());
  std::vector<std::size_t> outside;
  for (std::size_t i = 0; i < places_map_m.size(); ++i) {
    const Eigen::Vector2d& place = places_map_m[i];
    if (ground_->domain().contains(place.x(), place.y())) {
      grounds[i] = (*ground_)(place.x(), place.y());
    } else {
      outside.push_back(i);
    }
  }
  Eigen::Matrix2Xd points(2, static_cast<Eigen::Index>(outside.size()));
  for (std::size_t k = 0; k < outside.size(); ++k) {
    points.col(static_cast<Eigen::Index>(k)) = places_map_m[outside[k]];
  }
  const bool known = outside.empty() || plane_.geodetic_from_map(points);
  for (std::size_t k = 0; k < outside.size(); ++k) {
    const Eigen::Vector2d& place = places_map_m[outside[k]];
    const auto column = static_cast<Eigen::Index>(k);
    // One place beyond the projection's range makes PROJ refuse all.
    grounds[outside[k]] = known ? ground_from_geodetic(points(1, column), points(0, column))
                                : ground(place.x(), place.y());
  }
  std::vector<Eigen::Vector3d> all;
  all.reserve(grounds.size());
  for (std::size_t i = 0; i < grounds.size(); ++i) {
    all.emplace_back(grounds[i].head<3>() + heights_m[i] * grounds[i].tail<3>());
  }
  return all;
}

Eigen::Vector2d MapGeodesy::map_near(double east_m, double north_m) const {
  return middle_map_m_ + map_per_world_ * (Eigen::Vector2d(east_m, north_m) - middle_world_m_);
}

std::string world_fingerprint(const TileGrid& grid,
                              const std::vector<MappedImagery>& imagery,
                              const ElevationModel& elevation) {
  char text[256];
  std::snprintf(text,
                sizeof(text),
                "%d levels, %d x %d tiles of %.17g m from %.17g %.17g; ",
                grid.levels,
                grid.cols,
                grid.rows,
                grid.texel_m,
                grid.left_x_m,
                grid.top_y_m);
  std::string result = text;
  for (const MappedImagery& layer : imagery) result += layer.fingerprint() + "; ";
  return result + elevation.fingerprint();
}

TileCoverage RasterWorld::coverage(const TileId& id) const {
  TileCoverage best = TileCoverage::kNone;
  for (const MappedImagery& layer : imagery_) best = std::max(best, layer.coverage(id));
  return best;
}

Result<Tile> RasterWorld::read_tile(const TileId& id, const Cancelled& cancelled) const {
  if (id.level < 0 || id.level >= 24) {
    return Error{ErrorCode::kInvalidArgument,
                 "tile level = " + std::to_string(id.level) + ": must be in [0, 24)"};
  }
  if (cache_ && cache_->holds(id.level)) return cache_->tile(id);
  std::optional<Tile> result;
  for (const MappedImagery& layer : imagery_) {
    auto read = layer.read(id, cancelled);
    if (!read) return read;
    if (!result) {
      result = std::move(*read);
    } else {
      for (std::size_t i = 0; i < result->valid.data.size(); ++i) {
        if (result->valid.data[i] != 0 || read->valid.data[i] == 0) continue;
        result->valid.data[i] = 255;
        std::copy_n(&read->rgb.data[3 * i], 3, &result->rgb.data[3 * i]);
      }
    }
    const auto& valid = result->valid.data;
    if (std::find(valid.begin(), valid.end(), std::uint8_t{0}) == valid.end()) break;
  }
  return result ? std::move(*result) : void_patch(kTileSide, kTileSide);
}

Eigen::Vector3d RasterWorld::world_from_map(double x_map_m, double y_map_m) const {
  return geodesy_.world(x_map_m, y_map_m, elevation_.height_m(x_map_m, y_map_m));
}

Eigen::Vector3d RasterWorld::coarse_world_from_map(double x_map_m,
                                                   double y_map_m,
                                                   double spacing_m) const {
  return geodesy_.world(x_map_m, y_map_m, elevation_.coarse_height_m(x_map_m, y_map_m, spacing_m));
}

std::vector<Eigen::Vector3d> RasterWorld::coarse_world_at(
    std::span<const Eigen::Vector2d> places_map_m, double spacing_m) const {
  std::vector<double> heights_m;
  heights_m.reserve(places_map_m.size());
  for (const Eigen::Vector2d& place : places_map_m) {
    heights_m.push_back(elevation_.coarse_height_m(place.x(), place.y(), spacing_m));
  }
  return geodesy_.world(places_map_m, heights_m);
}

Eigen::Vector2d RasterWorld::map_from_world(double east_m, double north_m) const {
  const Eigen::Vector2d wanted(east_m, north_m);
  Eigen::Vector2d map = geodesy_.map_near(east_m, north_m);
  // The iteration converges: the map is conformal to a few percent, and the up axis tilts by the
  // distance over the earth's radius, times the ground's slope.
  constexpr int kMaxIterations = 30;
  constexpr double kCloseM = 1e-6;
  for (int i = 0; i < kMaxIterations; ++i) {
    const Eigen::Vector2d miss = wanted - world_from_map(map.x(), map.y()).head<2>();
    map += geodesy_.map_per_world() * miss;
    if (miss.squaredNorm() < kCloseM * kCloseM) break;
  }
  return map;
}

double RasterWorld::ground_up_m(double east_m, double north_m) const {
  const Eigen::Vector2d map = map_from_world(east_m, north_m);
  return world_from_map(map.x(), map.y()).z();
}

bool RasterWorld::has_imagery(double x_map_m, double y_map_m) const {
  return std::any_of(imagery_.begin(), imagery_.end(), [&](const MappedImagery& layer) {
    return layer.has_imagery(x_map_m, y_map_m);
  });
}

}  // namespace overfly::terrain
