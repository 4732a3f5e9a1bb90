#include "server/experiments/predict/features/view_features.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace overfly::server::predict {
namespace {

/// The pixel of a view's point from another pose.
std::optional<Eigen::Vector2d> pixel_from(const CameraModel& camera,
                                          const CameraView& view,
                                          const ViewPoint& point,
                                          const Pose& T_world_next) {
  const Eigen::Quaterniond R_next_world = T_world_next.rotation.conjugate();
  if (point.ground_world) {
    return camera.project(R_next_world * (*point.ground_world - T_world_next.translation));
  }
  return camera.project(R_next_world * (view.T_world_camera.rotation * point.ray_camera));
}

/// Length of the part of [middle - size / 2, middle + size / 2] in [-0.5, end - 0.5].
double inside(double middle, double size, double end) {
  const double low = std::max(middle - 0.5 * size, -0.5);
  const double high = std::min(middle + 0.5 * size, end - 0.5);
  return std::max(0.0, high - low);
}

}  // namespace

double relief_over_height(const CameraView& view) {
  std::vector<double> heights_m;
  for (const ViewPoint& point : view.points) {
    if (point.ground_world) heights_m.push_back(point.ground_world->z());
  }
  if (heights_m.empty()) return 0.0;
  std::sort(heights_m.begin(), heights_m.end());
  const double above_m = view.T_world_camera.translation.z() - heights_m[heights_m.size() / 2];
  return above_m > 0.0 ? (heights_m.back() - heights_m.front()) / above_m : 0.0;
}

double image_motion_px(const CameraModel& camera,
                       const CameraView& view,
                       const Pose& T_world_next) {
  double sum = 0.0;
  int count = 0;
  for (const ViewPoint& point : view.points) {
    const auto pixel = pixel_from(camera, view, point, T_world_next);
    if (!pixel) continue;
    sum += (*pixel - point.pixel).squaredNorm();
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0.0;
}

double overlap_with(const CameraModel& camera, const CameraView& view, const Pose& T_world_next) {
  const PinholeCamera& image = camera.pinhole();
  const double width = static_cast<double>(image.width_px) / kViewGrid;
  const double height = static_cast<double>(image.height_px) / kViewGrid;
  double area = 0.0;
  for (const ViewPoint& point : view.points) {
    const auto pixel = pixel_from(camera, view, point, T_world_next);
    if (!pixel) continue;
    area += inside(pixel->x(), width, image.width_px) * inside(pixel->y(), height, image.height_px);
  }
  return area / (static_cast<double>(image.width_px) * image.height_px);
}

}  // namespace overfly::server::predict
