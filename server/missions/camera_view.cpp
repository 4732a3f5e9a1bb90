#include "server/missions/camera_view.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

namespace overfly::server {
namespace {

/// Rays less steep than this do not meet the ground nearby: 2 deg below the horizon.
constexpr double kLeastSink = 0.035;
constexpr double kFarthestM = 30'000.0;

/// The ground on a ray, by the height at the place that the height before it gave: exact on level
/// ground, and within the last step on slopes less steep than the ray.
std::optional<Eigen::Vector3d> ground_on_ray(const Eigen::Vector3d& from_world,
                                             const Eigen::Vector3d& ray_world,
                                             const terrain::TileSource& tiles) {
  const Eigen::Vector3d direction = ray_world.normalized();
  if (direction.z() > -kLeastSink) return std::nullopt;
  constexpr int kRounds = 4;
  double ground_m = tiles.ground_up_m(from_world.x(), from_world.y());
  Eigen::Vector3d hit = from_world;
  for (int i = 0; i < kRounds; ++i) {
    const double range_m = (from_world.z() - ground_m) / -direction.z();
    if (!(range_m > 0.0 && range_m < kFarthestM)) return std::nullopt;
    hit = from_world + range_m * direction;
    ground_m = tiles.ground_up_m(hit.x(), hit.y());
  }
  return hit;
}

Eigen::Vector3d in_camera(const Pose& T_world_camera, const Eigen::Vector3d& p_world) {
  return T_world_camera.rotation.conjugate() * (p_world - T_world_camera.translation);
}

using Polygon = std::vector<Eigen::Vector2d>;

/// Twice the signed area.
double doubled_area(const Polygon& polygon) {
  double sum = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return sum;
}

/// Counterclockwise, seen from above.
Polygon polygon_of(const GroundQuad& quad) {
  Polygon polygon;
  for (const Eigen::Vector3d& corner : quad) polygon.emplace_back(corner.head<2>());
  if (doubled_area(polygon) < 0.0) std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

/// The part of a polygon to the left of the line from `a` to `b`.
Polygon clipped(const Polygon& polygon, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const auto side = [&](const Eigen::Vector2d& p) {
    return along.x() * (p.y() - a.y()) - along.y() * (p.x() - a.x());
  };
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& p = polygon[i];
    const Eigen::Vector2d& q = polygon[(i + 1) % polygon.size()];
    const double from = side(p);
    const double to = side(q);
    if (from >= 0.0) kept.push_back(p);
    if ((from > 0.0 && to < 0.0) || (from < 0.0 && to > 0.0)) {
      kept.push_back(p + from / (from - to) * (q - p));
    }
  }
  return kept;
}

}  // namespace

CameraView view_of(const CameraModel& camera,
                   const Pose& T_world_camera,
                   const terrain::TileSource& tiles) {
  CameraView view;
  view.T_world_camera = T_world_camera;
  const PinholeCamera& image = camera.pinhole();
  for (std::size_t i = 0; i < kViewPoints; ++i) {
    ViewPoint& point = view.points[i];
    const double column = static_cast<double>(i % kViewGrid) + 0.5;
    const double row = static_cast<double>(i / kViewGrid) + 0.5;
    point.pixel = {column * image.width_px / kViewGrid - 0.5,
                   row * image.height_px / kViewGrid - 0.5};
    const auto ray = camera.ray(point.pixel);
    if (!ray) continue;
    point.ray_camera = *ray;
    point.ground_world =
        ground_on_ray(T_world_camera.translation, T_world_camera.rotation * *ray, tiles);
  }
  return view;
}

double overlap_of(const GroundQuad& first, const GroundQuad& second) {
  const Polygon whole = polygon_of(first);
  const Polygon other = polygon_of(second);
  Polygon common = whole;
  for (std::size_t i = 0; i < other.size() && !common.empty(); ++i) {
    common = clipped(common, other[i], other[(i + 1) % other.size()]);
  }
  const double area = doubled_area(whole);
  return area > 0.0 ? doubled_area(common) / area : 0.0;
}

std::optional<GroundQuad> footprint_of(const CameraModel& camera,
                                       const Pose& T_world_camera,
                                       const terrain::TileSource& tiles) {
  const double right = camera.pinhole().width_px - 0.5;
  const double bottom = camera.pinhole().height_px - 0.5;
  const std::array<Eigen::Vector2d, 4> corners = {
      Eigen::Vector2d{-0.5, -0.5}, {right, -0.5}, {right, bottom}, {-0.5, bottom}};
  GroundQuad footprint;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto ray = camera.ray(corners[i]);
    if (!ray) return std::nullopt;
    const auto hit =
        ground_on_ray(T_world_camera.translation, T_world_camera.rotation * *ray, tiles);
    if (!hit) return std::nullopt;
    footprint[i] = *hit;
  }
  return footprint;
}

std::optional<double> texels_per_pixel(const CameraModel& camera,
                                       const CameraView& view,
                                       double texel_m) {
  const PinholeCamera& image = camera.pinhole();
  std::vector<double> texels;
  for (const ViewPoint& point : view.points) {
    if (!point.ground_world) continue;
    Eigen::Matrix2d J = Eigen::Matrix2d::Identity();
    if (!camera.distortion().none()) (void)camera.distort(point.ray_camera.head<2>(), &J);
    const double depth_m = in_camera(view.T_world_camera, *point.ground_world).z();
    const double sink = -(view.T_world_camera.rotation * point.ray_camera).z();
    // The pixel's area on a plane across the axis, projected along the ray onto level ground.
    const double area_m2 =
        depth_m * depth_m / (image.fx_px * image.fy_px * std::abs(J.determinant()) * sink);
    texels.push_back(std::sqrt(area_m2) / texel_m);
  }
  if (texels.empty()) return std::nullopt;
  const auto middle = texels.begin() + static_cast<std::ptrdiff_t>(texels.size() / 2);
  std::nth_element(texels.begin(), middle, texels.end());
  return *middle;
}

double imagery_share(const CameraView& view, const terrain::TileSource& tiles) {
  int over = 0;
  for (const ViewPoint& point : view.points) {
    if (!point.ground_world) continue;
    const Eigen::Vector2d map =
        tiles.map_from_world(point.ground_world->x(), point.ground_world->y());
    over += tiles.has_imagery(map.x(), map.y()) ? 1 : 0;
  }
  return static_cast<double>(over) / kViewPoints;
}

PixelMotion motion_of(const CameraModel& camera, const CameraView& view, const Pose& T_world_next) {
  double rotation = 0.0;
  double translation = 0.0;
  int turned = 0;
  int moved = 0;
  const Eigen::Quaterniond R_next_view =
      T_world_next.rotation.conjugate() * view.T_world_camera.rotation;
  for (const ViewPoint& point : view.points) {
    const auto rotated = camera.project(R_next_view * point.ray_camera);
    if (!rotated) continue;
    rotation += (*rotated - point.pixel).squaredNorm();
    ++turned;
    if (!point.ground_world) continue;
    const auto seen = camera.project(in_camera(T_world_next, *point.ground_world));
    if (!seen) continue;
    translation += (*seen - *rotated).squaredNorm();
    ++moved;
  }
  return {turned > 0 ? std::sqrt(rotation / turned) : 0.0,
          moved > 0 ? std::sqrt(translation / moved) : 0.0};
}

}  // namespace overfly::server
