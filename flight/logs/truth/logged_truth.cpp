#include "flight/logs/truth/logged_truth.hpp"

#include "core/cancel.hpp"
#include "core/text/number_text.hpp"

namespace overfly::flight::logs {
namespace {

/// Passes on what two streams hold for the time asked for.
class ChosenStreams final : public LogSink {
 public:
  ChosenStreams(const OpenedLog& log,
                const TruthChoice& truth,
                const TrajectoryRequest& request,
                TruthSampleSink& samples,
                const std::atomic<bool>* cancel)
      : log_(log), truth_(truth), request_(request), samples_(samples), cancel_(cancel) {}

  [[nodiscard]] bool stream(StreamId id, const StreamDescription& /*description*/) override {
    return id == truth_.position || id == truth_.attitude;
  }
  void message(StreamId /*id*/, const std::optional<LogTime>& /*time*/) override {}
  void local_origin(StreamId id, const LocalOrigin& origin) override {
    if (id != truth_.position) return;
    has_origin_ = true;
    samples_.local_origin(origin);
  }
  void event(LogEvent /*event*/) override {}
  void warning(const std::string& /*text*/) override {}
  [[nodiscard]] bool progress(std::uint64_t /*bytes*/) override { return !is_cancelled(cancel_); }

  [[nodiscard]] bool has_positions() const { return has_positions_; }
  [[nodiscard]] bool has_origin() const { return has_origin_; }

 private:
  [[nodiscard]] bool is_asked_for(std::int64_t t_ns, std::int64_t margin_ns) const {
    return (!request_.from_ns || t_ns >= *request_.from_ns - margin_ns) &&
           (!request_.to_ns || t_ns <= *request_.to_ns + margin_ns);
  }
  void take_position(StreamId id, const LogTime& time, const Eigen::Vector3d& value) override {
    if (id != truth_.position || !is_asked_for(time.t_ns, 0)) return;
    has_positions_ = true;
    samples_.position(time, value);
  }
  void take_attitude(StreamId id,
                     const LogTime& time,
                     const Eigen::Quaterniond& R_ned_body) override {
    LogTime moved = time;
    moved.t_ns += request_.attitude_offset_ns;
    if (id != truth_.attitude || !is_asked_for(moved.t_ns, request_.attitude_margin_ns)) return;
    samples_.attitude(moved, R_ned_body);
  }
  void take_invalid(StreamId /*id*/) override {}
  [[nodiscard]] PositionKind position_kind(StreamId id) const override {
    // The pass that opened the log met more streams only if the file has grown since.
    return id < log_.streams.size() ? log_.streams[id].description.position : PositionKind::kNone;
  }

  const OpenedLog& log_;
  const TruthChoice& truth_;
  const TrajectoryRequest& request_;
  TruthSampleSink& samples_;
  const std::atomic<bool>* cancel_;
  bool has_positions_ = false;
  bool has_origin_ = false;
};

}  // namespace

Result<LoggedTruth> read_truth_samples(const OpenedLog& log,
                                       const TrajectoryRequest& request,
                                       TruthSampleSink& sink,
                                       const std::atomic<bool>* cancel) {
  const Result<TruthChoice> choice = choose_truth(log, request.source);
  if (!choice) return choice.error();
  const StreamInfo& source = log.streams[choice->position];
  const auto failed = [&](const std::string& what) {
    return Error{ErrorCode::kUnreadable,
                 log.file.string() + ": " + source.description.name + ": " + what};
  };
  if (!choice->attitude) {
    std::string message = "no valid attitudes of the same vehicle are in the log";
    for (const StreamInfo& stream : log.streams) {
      const StreamDescription& description = stream.description;
      if (!description.attitude || description.vehicle != source.description.vehicle) continue;
      if (const std::string text = wrong_values_text(stream); !text.empty()) message += "; " + text;
    }
    return failed(message);
  }
  sink.expect(source.positions);
  ChosenStreams streams(log, *choice, request, sink, cancel);
  if (Status status = read_log_into(log, streams); !status) return status.error();
  if (!streams.has_positions()) return failed("no valid positions in the time asked for");

  LoggedTruth truth;
  truth.position_source = source.description.name;
  truth.attitude_source = log.streams[*choice->attitude].description.name;
  truth.height = source.description.height;
  truth.georeferenced =
      source.description.position == PositionKind::kGeodetic || streams.has_origin();
  return truth;
}

Result<double> separation_of(HeightDatum height,
                             const std::string& source,
                             double geoid_separation_m) {
  if (height == HeightDatum::kMeanSeaLevel) return geoid_separation_m;
  if (geoid_separation_m == 0.0) return 0.0;
  return Error{ErrorCode::kInvalidArgument,
               "geoid_separation_m = " + number_text(geoid_separation_m) + ": the heights of " +
                   source + " are above the ellipsoid already"};
}

}  // namespace overfly::flight::logs
