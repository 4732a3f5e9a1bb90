#include "flight/logs/log_trajectory.hpp"

#include <utility>

#include "core/cancel.hpp"
#include "flight/logs/pose_joiner.hpp"

namespace overfly::flight::logs {
namespace {

/// Passes the samples of two streams to a joiner.
class JoiningSink final : public LogSink {
 public:
  JoiningSink(const OpenedLog& log,
              const TruthChoice& truth,
              const TrajectoryRequest& request,
              const std::atomic<bool>* cancel)
      : poses(log.streams[truth.position].positions),
        log_(log),
        truth_(truth),
        request_(request),
        cancel_(cancel) {}

  [[nodiscard]] bool stream(StreamId id, const StreamDescription& /*description*/) override {
    return id == truth_.position || id == truth_.attitude;
  }
  void message(StreamId /*id*/, const std::optional<LogTime>& /*time*/) override {}
  void local_origin(StreamId id, const LocalOrigin& origin) override {
    if (id == truth_.position) poses.local_origin(origin);
  }
  void event(LogEvent /*event*/) override {}
  void warning(const std::string& /*text*/) override {}
  [[nodiscard]] bool progress(std::uint64_t /*bytes*/) override { return !is_cancelled(cancel_); }

  PoseJoiner poses;

 private:
  [[nodiscard]] bool is_asked_for(std::int64_t t_ns, std::int64_t margin_ns) const {
    return (!request_.from_ns || t_ns >= *request_.from_ns - margin_ns) &&
           (!request_.to_ns || t_ns <= *request_.to_ns + margin_ns);
  }
  void take_position(StreamId id, const LogTime& time, const Eigen::Vector3d& value) override {
    if (id != truth_.position || !is_asked_for(time.t_ns, 0)) return;
    poses.position(time, value);
  }
  void take_attitude(StreamId id,
                     const LogTime& time,
                     const Eigen::Quaterniond& R_ned_body) override {
    LogTime moved = time;
    moved.t_ns += request_.attitude_offset_ns;
    if (id != truth_.attitude || !is_asked_for(moved.t_ns, kMaxAttitudeStepNs)) return;
    poses.attitude(moved, R_ned_body);
  }
  void take_invalid(StreamId /*id*/) override {}
  [[nodiscard]] PositionKind position_kind(StreamId id) const override {
    // The pass that opened the log met more streams only if the file has grown since.
    return id < log_.streams.size() ? log_.streams[id].description.position : PositionKind::kNone;
  }

  const OpenedLog& log_;
  const TruthChoice& truth_;
  const TrajectoryRequest& request_;
  const std::atomic<bool>* cancel_;
};

}  // namespace

Result<LogTrajectory> read_log_trajectory(const OpenedLog& log,
                                          const TrajectoryRequest& request,
                                          const std::atomic<bool>* cancel) {
  const Result<TruthChoice> truth = choose_truth(log, request.source);
  if (!truth) return truth.error();
  const StreamInfo& source = log.streams[truth->position];
  const auto failed = [&](const std::string& what) {
    return Error{ErrorCode::kUnreadable,
                 log.file.string() + ": " + source.description.name + ": " + what};
  };
  if (!truth->attitude) return failed("no attitudes of the same vehicle are in the log");
  JoiningSink samples(log, *truth, request, cancel);
  if (Status status = read_log_into(log, samples); !status) return status.error();
  if (samples.poses.positions() == 0) return failed("no valid positions in the time asked for");

  LogTrajectory trajectory;
  trajectory.position_source = source.description.name;
  trajectory.attitude_source = log.streams[*truth->attitude].description.name;
  trajectory.height = source.description.height;
  trajectory.georeferenced =
      source.description.position == PositionKind::kGeodetic || samples.poses.has_origin();
  trajectory.poses = samples.poses.take_poses(trajectory.warnings);
  if (trajectory.poses.empty()) {
    return failed("no position has an attitude of " + trajectory.attitude_source +
                  " on both sides within 1 s");
  }
  return trajectory;
}

}  // namespace overfly::flight::logs
