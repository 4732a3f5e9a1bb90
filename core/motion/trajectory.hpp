// A trajectory: stamped poses of one frame in another, ordered by time.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <vector>

#include "core/motion/pose.hpp"
#include "core/result.hpp"

namespace overfly {

struct StampedPose {
  std::int64_t t_ns = 0;
  Pose pose;
};

class Trajectory {
 public:
  Trajectory() = default;
  /// Errors: kInvalidArgument if the stamps do not strictly increase (the message gives the index),
  /// if a pose is not finite, or if a quaternion has zero norm. Quaternions are normalised.
  static Result<Trajectory> from_poses(const std::vector<StampedPose>& poses);

  /// Appends one pose. Errors: as from_poses.
  Status append(const StampedPose& stamped);

  /// Marks a gap: between the last pose and the next one appended the pose is unknown.
  void append_gap();

  /// Marks a gap between pose i - 1 and pose i. @pre 0 < i < size()
  void mark_gap_before(std::size_t i) { after_gap_.insert(i); }
  /// Whether the pose between pose i - 1 and pose i is unknown.
  [[nodiscard]] bool has_gap_before(std::size_t i) const { return after_gap_.contains(i); }

  [[nodiscard]] const std::vector<StampedPose>& poses() const { return poses_; }
  [[nodiscard]] bool empty() const { return poses_.empty(); }
  [[nodiscard]] std::size_t size() const { return poses_.size(); }
  /// @pre !empty()
  [[nodiscard]] std::int64_t begin_ns() const { return poses_.front().t_ns; }
  [[nodiscard]] std::int64_t end_ns() const { return poses_.back().t_ns; }

  /// The pose at t: linear in position, SLERP in rotation. Empty outside [begin, end] and in gaps.
  [[nodiscard]] std::optional<Pose> at(std::int64_t t_ns) const;
  /// Index of the pose whose stamp is nearest to t. @pre !empty()
  [[nodiscard]] std::size_t nearest(std::int64_t t_ns) const;
  /// Length of the polyline through the positions up to a time [m], excluding gaps.
  [[nodiscard]] double path_length_m(
      std::int64_t until_ns = std::numeric_limits<std::int64_t>::max()) const;

 private:
  std::vector<StampedPose> poses_;
  std::set<std::size_t> after_gap_;  ///< indices of poses
};

}  // namespace overfly
