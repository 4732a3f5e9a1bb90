#include "core/camera/camera_motion.hpp"

#include <algorithm>

namespace overfly {

CameraMotion::CameraMotion(const Pose& T_world_camera) : poses_{{0, T_world_camera}} {}

Result<CameraMotion> CameraMotion::from_poses(const std::vector<StampedPose>& T_world_camera) {
  if (T_world_camera.empty()) {
    return Error{ErrorCode::kInvalidArgument, "camera motion: 0 poses: must be at least 1"};
  }
  Result<Trajectory> checked = Trajectory::from_poses(T_world_camera);
  if (!checked) return checked.error().in("camera motion");
  CameraMotion motion;
  motion.poses_ = checked->poses();
  return motion;
}

Pose CameraMotion::at(std::int64_t t_ns) const {
  if (t_ns <= poses_.front().t_ns || poses_.size() == 1) return poses_.front().pose;
  if (t_ns >= poses_.back().t_ns) return poses_.back().pose;
  const auto after = std::upper_bound(
      poses_.begin(), poses_.end(), t_ns, [](std::int64_t t, const StampedPose& p) {
        return t < p.t_ns;
      });
  const auto before = after - 1;
  const double alpha =
      static_cast<double>(t_ns - before->t_ns) / static_cast<double>(after->t_ns - before->t_ns);
  return interpolate(before->pose, after->pose, alpha);
}

}  // namespace overfly
