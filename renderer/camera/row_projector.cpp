#include "renderer/camera/row_projector.hpp"

#include <algorithm>
#include <cmath>

namespace overfly::renderer {

RowProjector::RowProjector(const CameraRequest& request) : camera_(request.camera) {
  const bool rolling = request.readout_ns != 0 && !request.T_world_camera.still();
  const int rows = rolling ? camera_.pinhole().height_px : 1;
  rows_.reserve(static_cast<std::size_t>(rows));
  for (int row = 0; row < rows; ++row) {
    const std::int64_t t_ns = rolling ? request.row_time_ns(row) : request.t_ns;
    RowPose pose;
    pose.T_world_camera = request.T_world_camera.at(t_ns);
    pose.R_camera_world = pose.T_world_camera.rotation.toRotationMatrix().transpose();
    pose.centre_world = pose.T_world_camera.translation;
    rows_.push_back(pose);
  }
}

const Pose& RowProjector::T_world_camera(int row) const {
  return rows_[rows_.size() == 1 ? 0 : static_cast<std::size_t>(row)].T_world_camera;
}

bool RowProjector::inside(const Eigen::Vector2d& pixel) const {
  return pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() <= camera_.pinhole().width_px - 1 &&
         pixel.y() <= camera_.pinhole().height_px - 1;
}

std::optional<ProjectedPoint> RowProjector::project_from(const RowPose& pose,
                                                         const Eigen::Vector3d& p_world) const {
  const Eigen::Vector3d p_camera = pose.R_camera_world * (p_world - pose.centre_world);
  const auto pixel = camera_.project(p_camera);
  if (!pixel) return std::nullopt;
  return ProjectedPoint{*pixel, p_camera.z()};
}

std::optional<ProjectedPoint> RowProjector::project(const Eigen::Vector3d& p_world) const {
  if (rows_.size() == 1) return project_from(rows_.front(), p_world);
  constexpr int kIterations = 20;
  constexpr double kCloseRows = 1e-6;
  const auto last = static_cast<double>(rows_.size() - 1);
  double row = 0.5 * last;
  for (int i = 0; i < kIterations; ++i) {
    const auto above = static_cast<std::size_t>(std::clamp(std::floor(row), 0.0, last - 1.0));
    const auto upper = project_from(rows_[above], p_world);
    const auto lower = project_from(rows_[above + 1], p_world);
    if (!upper || !lower) return std::nullopt;
    const double share = std::clamp(row - static_cast<double>(above), 0.0, 1.0);
    const ProjectedPoint point{(1.0 - share) * upper->pixel + share * lower->pixel,
                               (1.0 - share) * upper->depth_m + share * lower->depth_m};
    if (std::abs(point.pixel.y() - row) < kCloseRows) return point;
    // No row is exposed beyond the image: the pose of the border's row is used there.
    if (i > 0 && (row < 0.0 || row > last) && (point.pixel.y() < 0.0 || point.pixel.y() > last)) {
      return point;
    }
    row = point.pixel.y();
  }
  return std::nullopt;
}

}  // namespace overfly::renderer
