#include "core/motion/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace overfly {

Result<Trajectory> Trajectory::from_poses(const std::vector<StampedPose>& poses) {
  Trajectory trajectory;
  trajectory.poses_.reserve(poses.size());
  for (const StampedPose& stamped : poses) {
    if (Status status = trajectory.append(stamped); !status) return status.error();
  }
  return trajectory;
}

Status Trajectory::append(const StampedPose& stamped) {
  const std::string where = "pose " + std::to_string(poses_.size());
  if (!poses_.empty() && stamped.t_ns <= poses_.back().t_ns) {
    return Error{ErrorCode::kInvalidArgument,
                 where + ": time " + std::to_string(stamped.t_ns) + " ns is not after " +
                     std::to_string(poses_.back().t_ns) + " ns"};
  }
  const double norm = stamped.pose.rotation.norm();
  if (!stamped.pose.translation.allFinite() || !stamped.pose.rotation.coeffs().allFinite()) {
    return Error{ErrorCode::kInvalidArgument, where + ": contains a value that is not finite"};
  }
  if (norm < 1e-6) {
    return Error{ErrorCode::kInvalidArgument, where + ": the quaternion has zero norm"};
  }
  poses_.push_back(stamped);
  // Do not normalise a quaternion of unit norm again: its last bits could change, and a file that
  // is read and written back must be identical.
  constexpr double kUnitTolerance = 1e-15;
  if (std::abs(norm - 1.0) > kUnitTolerance) poses_.back().pose.rotation.normalize();
  return {};
}

void Trajectory::append_gap() {
  if (!poses_.empty()) after_gap_.insert(poses_.size());
}

std::optional<Pose> Trajectory::at(std::int64_t t_ns) const {
  if (poses_.empty() || t_ns < begin_ns() || t_ns > end_ns()) return std::nullopt;
  const auto after = std::lower_bound(
      poses_.begin(), poses_.end(), t_ns, [](const StampedPose& stamped, std::int64_t t) {
        return stamped.t_ns < t;
      });
  if (after->t_ns == t_ns) return after->pose;
  if (after_gap_.contains(static_cast<std::size_t>(after - poses_.begin()))) return std::nullopt;
  const auto before = std::prev(after);
  const double alpha =
      static_cast<double>(t_ns - before->t_ns) / static_cast<double>(after->t_ns - before->t_ns);
  return interpolate(before->pose, after->pose, alpha);
}

std::size_t Trajectory::nearest(std::int64_t t_ns) const {
  const auto after = std::lower_bound(
      poses_.begin(), poses_.end(), t_ns, [](const StampedPose& stamped, std::int64_t t) {
        return stamped.t_ns < t;
      });
  if (after == poses_.begin()) return 0;
  if (after == poses_.end()) return poses_.size() - 1;
  const auto before = std::prev(after);
  const bool before_is_nearer = t_ns - before->t_ns <= after->t_ns - t_ns;
  return static_cast<std::size_t>((before_is_nearer ? before : after) - poses_.begin());
}

double Trajectory::path_length_m(std::int64_t until_ns) const {
  double length_m = 0.0;
  for (std::size_t i = 1; i < poses_.size() && poses_[i].t_ns <= until_ns; ++i) {
    if (after_gap_.contains(i)) continue;
    length_m += (poses_[i].pose.translation - poses_[i - 1].pose.translation).norm();
  }
  return length_m;
}

}  // namespace overfly
