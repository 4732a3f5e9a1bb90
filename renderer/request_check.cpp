#include "renderer/request_check.hpp"

#include <cmath>
#include <string>

#include "core/time.hpp"

namespace overfly::renderer {

namespace {

Status check_size(int width_px, int height_px) {
  const auto outside = [](int size) { return size < 1 || size > kMaxImageSidePx; };
  if (outside(width_px) || outside(height_px)) {
    return Error{ErrorCode::kInvalidArgument,
                 "image size " + std::to_string(width_px) + " x " + std::to_string(height_px) +
                     " px: each side must be in [1, " + std::to_string(kMaxImageSidePx) + "]"};
  }
  return {};
}

std::string text_of(const Eigen::Vector3d& v) {
  std::string text(1, '(');
  text += std::to_string(v.x()) + ", " + std::to_string(v.y()) + ", " + std::to_string(v.z());
  return text += ')';
}

/// True if a component is outside [-limit, limit] or not a number.
bool beyond(const Eigen::Vector3d& v, double limit) { return !(v.array().abs() <= limit).all(); }

Status check_pose(const Pose& pose) {
  if (!pose.translation.allFinite() || !pose.rotation.coeffs().allFinite()) {
    return Error{ErrorCode::kInvalidArgument, "T_world_camera is not finite"};
  }
  if (beyond(pose.translation, kMaxPositionM)) {
    return Error{ErrorCode::kInvalidArgument,
                 "T_world_camera.translation = " + text_of(pose.translation) +
                     " m: each component must be in [-1000000, 1000000]"};
  }
  const double norm = pose.rotation.norm();
  if (std::abs(norm - 1.0) > 1e-3) {
    return Error{ErrorCode::kInvalidArgument,
                 "T_world_camera.rotation has norm " + std::to_string(norm) + ": must be 1"};
  }
  return {};
}

Status check_shutter(const CameraRequest& request) {
  const auto check = [](const char* field, std::int64_t value_ns) -> Status {
    if (value_ns >= 0 && value_ns <= kNsPerS) return {};
    return Error{
        ErrorCode::kInvalidArgument,
        std::string(field) + " = " + std::to_string(value_ns) + " ns: must be in [0, 1000000000]"};
  };
  if (Status status = check("exposure_ns", request.exposure_ns); !status) return status;
  return check("readout_ns", request.readout_ns);
}

Status check_air(const Atmosphere& air) {
  if (!(air.extinction_per_m >= 0.0 && air.extinction_per_m <= 1.0)) {
    return Error{
        ErrorCode::kInvalidArgument,
        "extinction_per_m = " + std::to_string(air.extinction_per_m) + ": must be in [0, 1]"};
  }
  for (const float value : air.airlight_rgb) {
    if (value >= 0.0F && value <= 1.0F) continue;
    return Error{ErrorCode::kInvalidArgument,
                 "airlight_rgb has the value " + std::to_string(value) + ": must be in [0, 1]"};
  }
  return {};
}

Status check_velocity(const Eigen::Vector3d& velocity_m_s) {
  if (!beyond(velocity_m_s, kMaxSpeedMPerS)) return {};
  return Error{ErrorCode::kInvalidArgument,
               "velocity_world_m_s = " + text_of(velocity_m_s) +
                   ": each component must be in [-10000, 10000]"};
}

}  // namespace

std::int64_t CameraRequest::row_time_ns(double row) const {
  const int rows = camera.pinhole().height_px;
  if (readout_ns == 0 || rows < 2) return t_ns;
  const double share = row / (rows - 1) - 0.5;
  return t_ns + std::llround(share * static_cast<double>(readout_ns));
}

Status check_camera_request(const terrain::TileSource& tiles, const CameraRequest& request) {
  if (Status status = request.camera.validate(); !status) return status.error().in("camera");
  const PinholeCamera& pinhole = request.camera.pinhole();
  if (Status status = check_size(pinhole.width_px, pinhole.height_px); !status) return status;
  if (Status status = check_shutter(request); !status) return status;
  if (Status status = check_air(request.atmosphere); !status) return status;
  if (Status status = check_velocity(request.velocity_world_m_s); !status) return status;
  for (const StampedPose& stamped : request.T_world_camera.poses()) {
    if (Status status = check_pose(stamped.pose); !status) return status;
  }
  const Eigen::Vector3d p = request.T_world_camera.at(request.t_ns).translation;
  const double below_m = tiles.ground_up_m(p.x(), p.y()) - p.z();
  if (below_m > kMaxDepthBelowGroundM) {
    return Error{ErrorCode::kInvalidArgument,
                 "T_world_camera: the camera is " + std::to_string(below_m) +
                     " m below the ground; at most " + std::to_string(kMaxDepthBelowGroundM) +
                     " m is allowed"};
  }
  return {};
}

Result<PinholeCamera> camera_of(const SceneView& view) {
  if (Status status = check_size(view.width_px, view.height_px); !status) return status.error();
  if (Status status = check_pose(view.T_world_camera); !status) return status.error();
  auto camera =
      PinholeCamera::from_fov(view.width_px, view.height_px, view.fov_y_rad, FovAxis::kVertical);
  if (!camera.ok()) return camera.error().in("scene view: fov_y_rad");
  return camera;
}

}  // namespace overfly::renderer
