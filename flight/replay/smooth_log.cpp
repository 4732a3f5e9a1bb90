#include "flight/replay/smooth_log.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/text/number_text.hpp"
#include "core/time.hpp"
#include "flight/logs/log_samples.hpp"
#include "flight/logs/ned_attitude.hpp"

namespace overfly::flight {
namespace {

/// Longer bridges are uncertain by metres.
constexpr double kLongGapS = 2.0;

Geodetic geodetic_of_sample(const Eigen::Vector3d& value, double geoid_separation_m) {
  return geodetic_from_deg(value.x(), value.y(), value.z() + geoid_separation_m);
}

void warn_of_gaps(const smoothing::FitReport& report,
                  const std::string& source,
                  std::vector<std::string>& warnings) {
  if (report.longest_gap_s <= kLongGapS) return;
  warnings.push_back(source + ": a gap of " + short_text(report.longest_gap_s) +
                     " s is bridged without any sample");
}

}  // namespace

std::int64_t SmoothedLog::begin_ns() const {
  return epoch_ns + static_cast<std::int64_t>(std::ceil(smoothed.motion.begin_s * 1e9));
}

std::int64_t SmoothedLog::end_ns() const {
  return epoch_ns + static_cast<std::int64_t>(std::floor(smoothed.motion.end_s * 1e9));
}

Pose SmoothedLog::pose(const smoothing::MotionState& state) const {
  const Geodetic point = frame.geodetic_from_world(state.p_world_m);
  return {frame.R_world_enu_at(point) * logs::R_enu_ned() * state.R_ned_body, state.p_world_m};
}

Result<SmoothedLog> smooth_log(const logs::OpenedLog& log,
                               const logs::TrajectoryRequest& request,
                               const smoothing::SmoothingOptions& options,
                               double geoid_separation_m,
                               const std::atomic<bool>* cancel,
                               const smoothing::SmoothingProgress& progress) {
  const std::string name = log.file.string();
  logs::TrajectoryRequest wider = request;
  // The smoother moves the attitudes by the time offset: up to so much outside is needed.
  wider.attitude_margin_ns =
      std::max(logs::kMaxAttitudeStepNs, ns_from_s(smoothing::kMaxTimeOffsetS));
  Result<logs::LogSamples> samples = logs::read_log_samples(log, wider, cancel);
  if (!samples) return samples.error();
  if (!samples->georeferenced) {
    return Error{ErrorCode::kUnsupported,
                 name + ": the positions of " + samples->position_source +
                     " count from an origin that the log does not state: they cannot be smoothed"};
  }
  const Result<double> separation =
      logs::separation_of(samples->height, samples->position_source, geoid_separation_m);
  if (!separation) return separation.error().in(name);
  const std::int64_t epoch_ns = samples->positions.front().t_ns;
  const LocalFrame frame(geodetic_of_sample(samples->positions.front().value, *separation));
  std::vector<smoothing::PositionSample> positions;
  positions.reserve(samples->positions.size());
  for (const logs::LogPosition& position : samples->positions) {
    positions.push_back(
        {s_from_ns(position.t_ns - epoch_ns),
         frame.world_from_geodetic(geodetic_of_sample(position.value, *separation))});
  }
  std::vector<smoothing::AttitudeSample> attitudes;
  attitudes.reserve(samples->attitudes.size());
  for (const logs::LogAttitude& attitude : samples->attitudes) {
    attitudes.push_back(
        {s_from_ns(attitude.t_ns - epoch_ns), attitude.R_ned_body.cast<double>().normalized()});
  }
  Result<smoothing::SmoothedMotion> smoothed =
      smoothing::smooth_motion(positions, attitudes, options, cancel, progress);
  if (!smoothed) return smoothed.error().in(name);
  warn_of_gaps(smoothed->positions, samples->position_source, samples->warnings);
  warn_of_gaps(smoothed->attitudes, samples->attitude_source, samples->warnings);
  return SmoothedLog{epoch_ns,
                     frame,
                     samples->height,
                     *separation,
                     std::move(*smoothed),
                     std::move(samples->position_source),
                     std::move(samples->attitude_source),
                     samples->boot,
                     std::move(samples->warnings)};
}

}  // namespace overfly::flight
