#include "flight/logs/truth/log_trajectory.hpp"

#include <utility>

#include "flight/logs/truth/pose_joiner.hpp"

namespace overfly::flight::logs {

Result<LogTrajectory> read_log_trajectory(const OpenedLog& log,
                                          const TrajectoryRequest& request,
                                          const std::atomic<bool>* cancel) {
  PoseJoiner joiner(request.keep_attitudes);
  Result<LoggedTruth> truth = read_truth_samples(log, request, joiner, cancel);
  if (!truth) return truth.error();
  LogTrajectory trajectory{std::move(*truth), {}, {}};
  PoseJoiner::JoinedPoses joined = joiner.take_poses(trajectory.warnings);
  trajectory.boot = joined.boot;
  trajectory.poses = std::move(joined.poses);
  if (trajectory.poses.empty()) {
    return Error{ErrorCode::kUnreadable,
                 log.file.string() + ": " + trajectory.position_source +
                     ": no position has an attitude of " + trajectory.attitude_source +
                     " on both sides within 1 s"};
  }
  trajectory.attitudes = joiner.take_attitudes();
  return trajectory;
}

}  // namespace overfly::flight::logs
