#include "renderer/raycast/ground/view_sweep.hpp"

#include <algorithm>

namespace overfly::renderer::raycast {

namespace {

/// Instants that represent the whole exposure: evenly spaced, plus all given poses in between.
std::vector<Pose> poses_of(const CameraRequest& request) {
  const CameraMotion& motion = request.T_world_camera;
  if (motion.still()) return {motion.at(request.t_ns)};
  const std::int64_t from_ns = request.t_ns - (request.readout_ns + request.exposure_ns) / 2 - 1;
  const std::int64_t all_ns = request.readout_ns + request.exposure_ns + 2;
  constexpr int kPieces = 8;
  std::vector<Pose> poses;
  for (int i = 0; i <= kPieces; ++i) poses.push_back(motion.at(from_ns + all_ns * i / kPieces));
  for (const StampedPose& stamped : motion.poses()) {
    if (stamped.t_ns >= from_ns && stamped.t_ns <= from_ns + all_ns) poses.push_back(stamped.pose);
  }
  return poses;
}

/// Rays of the image's edge, every few nodes.
std::vector<Eigen::Vector2d> edge_rays(const RayGrid& rays) {
  std::vector<Eigen::Vector2d> edge;
  const auto add = [&](int column, int row) {
    if (rays.ray(column, row).allFinite()) edge.push_back(rays.ray(column, row));
  };
  for (int column = 0; column <= rays.columns(); ++column) {
    add(column, 0);
    add(column, rays.rows());
  }
  for (int row = 0; row <= rays.rows(); ++row) {
    add(0, row);
    add(rays.columns(), row);
  }
  return edge;
}

}  // namespace

ViewSweep sweep_of(const CameraRequest& request, const RayGrid& rays) {
  const Pose middle = request.T_world_camera.at(request.t_ns);
  ViewSweep sweep;
  sweep.position = middle.translation;
  sweep.px_per_rad = rays.px_per_rad();
  const Eigen::Matrix3d R_world_camera = middle.rotation.normalized().toRotationMatrix();
  Eigen::Array2d low = Eigen::Array2d::Constant(1e9);
  Eigen::Array2d high = -low;
  bool bounded = true;
  const std::vector<Eigen::Vector2d> edge = edge_rays(rays);
  for (const Pose& pose : poses_of(request)) {
    sweep.slack_m = std::max(sweep.slack_m, (pose.translation - middle.translation).norm());
    const Eigen::Matrix3d R_middle_pose =
        R_world_camera.transpose() * pose.rotation.normalized().toRotationMatrix();
    for (const Eigen::Vector2d& ray : edge) {
      const Eigen::Vector3d seen = R_middle_pose * Eigen::Vector3d(ray.x(), ray.y(), 1.0);
      if (seen.z() < 0.05 * seen.norm()) {
        bounded = false;
        break;
      }
      low = low.min(seen.head<2>().array() / seen.z());
      high = high.max(seen.head<2>().array() / seen.z());
    }
  }
  if (edge.empty() || !bounded) return sweep;
  // Margin for rays and instants between the examined ones.
  const Eigen::Array2d room = 0.02 * (high - low) + 1e-3;
  low -= room;
  high += room;
  sweep.bounded = true;
  sweep.side_normals = {Eigen::Vector3d(1.0, 0.0, -low.x()),
                        Eigen::Vector3d(-1.0, 0.0, high.x()),
                        Eigen::Vector3d(0.0, 1.0, -low.y()),
                        Eigen::Vector3d(0.0, -1.0, high.y())};
  for (Eigen::Vector3d& normal : sweep.side_normals) {
    normal = R_world_camera * normal.normalized();
  }
  for (int i = 0; i < 4; ++i) {
    sweep.corners[i] =
        R_world_camera *
        Eigen::Vector3d((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(), 1.0);
  }
  return sweep;
}

}  // namespace overfly::renderer::raycast
