// The camera's motion during the exposure and readout of one image.
#pragma once

#include <cstdint>
#include <vector>

#include "core/motion/pose.hpp"
#include "core/motion/trajectory.hpp"
#include "core/result.hpp"

namespace overfly {

/// T_world_camera over a short time. Constant before the first and after the last pose.
class CameraMotion {
 public:
  /// A camera that does not move.
  CameraMotion(const Pose& T_world_camera = {});
  /// Errors: kInvalidArgument if `T_world_camera` is empty, and the errors of
  /// Trajectory::from_poses.
  static Result<CameraMotion> from_poses(const std::vector<StampedPose>& T_world_camera);

  /// Linear in position, SLERP in rotation.
  [[nodiscard]] Pose at(std::int64_t t_ns) const;
  [[nodiscard]] bool still() const { return poses_.size() == 1; }
  [[nodiscard]] const std::vector<StampedPose>& poses() const { return poses_; }

 private:
  std::vector<StampedPose> poses_;
};

}  // namespace overfly
