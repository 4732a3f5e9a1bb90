#include "flight/logs/log_trajectory.hpp"

#include <utility>

#include "core/time.hpp"

namespace overfly::flight::logs {
namespace {

/// An attitude further away than this says nothing about a position.
constexpr std::int64_t kMaxAttitudeStepNs = kNsPerS;

/// Interpolates attitudes at increasing times.
class AttitudeCursor {
 public:
  explicit AttitudeCursor(const std::vector<LogAttitude>& attitudes) : attitudes_(attitudes) {}

  std::optional<Eigen::Quaterniond> at(std::int64_t t_ns) {
    while (next_ < attitudes_.size() && attitudes_[next_].t_ns < t_ns) ++next_;
    if (next_ == attitudes_.size()) return std::nullopt;
    const LogAttitude& after = attitudes_[next_];
    if (after.t_ns == t_ns) return after.R_ned_body.cast<double>().normalized();
    if (next_ == 0) return std::nullopt;
    const LogAttitude& before = attitudes_[next_ - 1];
    if (after.t_ns - t_ns > kMaxAttitudeStepNs || t_ns - before.t_ns > kMaxAttitudeStepNs) {
      return std::nullopt;
    }
    const double part =
        static_cast<double>(t_ns - before.t_ns) / static_cast<double>(after.t_ns - before.t_ns);
    return before.R_ned_body.cast<double>().normalized().slerp(
        part, after.R_ned_body.cast<double>().normalized());
  }

 private:
  const std::vector<LogAttitude>& attitudes_;
  std::size_t next_ = 0;
};

}  // namespace

Result<LogTrajectory> read_log_trajectory(const OpenedLog& log,
                                          const TrajectoryRequest& request,
                                          const std::atomic<bool>* cancel) {
  Result<LogSamples> samples = read_log_samples(log, request, cancel);
  if (!samples) return samples.error();
  LogTrajectory trajectory;
  trajectory.georeferenced = samples->georeferenced;
  trajectory.position_source = std::move(samples->position_source);
  trajectory.attitude_source = std::move(samples->attitude_source);
  trajectory.warnings = std::move(samples->warnings);
  trajectory.poses.reserve(samples->positions.size());
  AttitudeCursor cursor(samples->attitudes);
  for (const LogPosition& position : samples->positions) {
    const std::optional<Eigen::Quaterniond> attitude = cursor.at(position.t_ns);
    if (attitude) trajectory.poses.push_back({position.t_ns, position.value, *attitude});
  }
  if (trajectory.poses.empty()) {
    return Error{ErrorCode::kUnreadable,
                 log.file.string() + ": " + trajectory.position_source +
                     ": no position has an attitude of " + trajectory.attitude_source +
                     " on both sides within 1 s"};
  }
  const std::size_t without_attitude = samples->positions.size() - trajectory.poses.size();
  if (without_attitude > 0) {
    trajectory.warnings.push_back(std::to_string(without_attitude) +
                                  " positions were left out: no attitude on both sides within 1 s");
  }
  return trajectory;
}

}  // namespace overfly::flight::logs
