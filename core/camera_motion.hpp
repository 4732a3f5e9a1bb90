// Where a camera was while one image was exposed and read out.
#pragma once

#include <cstdint>
#include <vector>

#include "core/pose.hpp"
#include "core/result.hpp"
#include "core/trajectory.hpp"

namespace overfly {

/// T_world_camera over a short time. Before the first and after the last pose it stands still.
class CameraMotion {
 public:
  /// A camera that stands still.
  CameraMotion(const Pose& T_world_camera = {});
  /// Errors: kInvalidArgument for no pose, and as Trajectory's.
  static Result<CameraMotion> from_poses(const std::vector<StampedPose>& T_world_camera);

  /// Linear in position, SLERP in rotation.
  [[nodiscard]] Pose at(std::int64_t t_ns) const;
  [[nodiscard]] bool still() const { return poses_.size() == 1; }
  [[nodiscard]] const std::vector<StampedPose>& poses() const { return poses_; }

 private:
  std::vector<StampedPose> poses_;
};

}  // namespace overfly
