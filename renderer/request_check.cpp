#include "renderer/request_check.hpp"

#include <cmath>
#include <string>

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

Status check_pose(const Pose& pose) {
  if (!pose.translation.allFinite() || !pose.rotation.coeffs().allFinite()) {
    return Error{ErrorCode::kInvalidArgument, "T_world_camera is not finite"};
  }
  const double norm = pose.rotation.norm();
  if (std::abs(norm - 1.0) > 1e-3) {
    return Error{ErrorCode::kInvalidArgument,
                 "T_world_camera.rotation has norm " + std::to_string(norm) + ": must be 1"};
  }
  return {};
}

}  // namespace

Status check_camera_request(const terrain::TileSource& tiles,
                            const PinholeCamera& camera,
                            const Pose& T_world_camera) {
  if (Status status = camera.validate(); !status) return status.error().in("camera");
  if (Status status = check_size(camera.width_px, camera.height_px); !status) return status;
  if (Status status = check_pose(T_world_camera); !status) return status;
  const Eigen::Vector3d& p = T_world_camera.translation;
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
