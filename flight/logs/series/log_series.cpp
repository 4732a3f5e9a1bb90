#include "flight/logs/series/log_series.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "core/cancel.hpp"
#include "core/motion/pose.hpp"
#include "core/time.hpp"
#include "flight/logs/ned_attitude.hpp"

namespace overfly::flight::logs {
namespace {

constexpr std::size_t kMaxRuns = 8;  ///< that are held
constexpr std::int64_t kSpeedIntervalNs = kNsPerS / 5;
constexpr double kStepM = 20.0;
constexpr double kStepSpeedMS = 150.0;
/// Of a sphere: 0.6 % off WGS84 at most, less than what a plot shows.
constexpr double kMetresPerDeg = 111195.0;

/// North and east of `to` from `from` [m].
Eigen::Vector2d ground_step_m(bool geodetic,
                              const Eigen::Vector3d& from,
                              const Eigen::Vector3d& to) {
  const Eigen::Vector2d step = (to - from).head<2>();
  if (!geodetic) return step;
  const double lon_deg = std::remainder(step.y(), 360.0);
  return kMetresPerDeg * Eigen::Vector2d(step.x(), lon_deg * std::cos(rad_from_deg(from.x())));
}

/// The series of the time between two starts of a clock.
class RunOfClock {
 public:
  explicit RunOfClock(std::size_t max_intervals)
      : positions(3, max_intervals), speeds(1, max_intervals), attitudes(3, max_intervals) {}

  /// @param value  latitude, longitude [deg], height; or north, east, up [m]
  void add(std::int64_t t_ns, const Eigen::Vector3d& value, bool geodetic) {
    positions.add({t_ns, {value.x(), value.y(), value.z()}});
    find_step(t_ns, value, geodetic);
    if (!anchor_ || t_ns < anchor_->first) {
      anchor_ = {t_ns, value};
    } else if (t_ns - anchor_->first >= kSpeedIntervalNs) {
      const double way_m = ground_step_m(geodetic, anchor_->second, value).norm();
      speeds.add({t_ns, {way_m / s_from_ns(t_ns - anchor_->first)}});
      anchor_ = {t_ns, value};
    }
  }

  BoundedSeries positions;
  BoundedSeries speeds;
  BoundedSeries attitudes;
  std::vector<LogStep> steps;

 private:
  void find_step(std::int64_t t_ns, const Eigen::Vector3d& value, bool geodetic) {
    if (last_ && t_ns >= last_->first) {
      const double size_m = std::hypot(ground_step_m(geodetic, last_->second, value).norm(),
                                       value.z() - last_->second.z());
      const bool is_step = size_m > kStepM + kStepSpeedMS * s_from_ns(t_ns - last_->first);
      if (is_step && steps.size() < kMaxLogSteps) steps.push_back({t_ns, size_m});
    }
    last_ = {t_ns, value};
  }

  std::optional<std::pair<std::int64_t, Eigen::Vector3d>> last_;
  std::optional<std::pair<std::int64_t, Eigen::Vector3d>> anchor_;  ///< where a speed begins
};

class SeriesSink final : public LogSink {
 public:
  SeriesSink(const OpenedLog& log,
             const TruthChoice& truth,
             std::size_t max_intervals,
             const std::atomic<bool>* cancel)
      : log_(log), truth_(truth), max_intervals_(max_intervals), cancel_(cancel) {}

  [[nodiscard]] bool stream(StreamId id, const StreamDescription& /*description*/) override {
    return id == truth_.position || id == truth_.attitude;
  }
  void message(StreamId /*id*/, const std::optional<LogTime>& /*time*/) override {}
  void local_origin(StreamId id, const LocalOrigin& origin) override {
    if (id == truth_.position) origin_ = origin;
  }
  void event(LogEvent /*event*/) override {}
  void warning(const std::string& /*text*/) override {}
  [[nodiscard]] bool progress(std::uint64_t /*bytes*/) override { return !is_cancelled(cancel_); }

  /// With the number of its boot. Null if there are no positions.
  [[nodiscard]] const std::pair<const std::uint32_t, RunOfClock>* main_run() const {
    const std::pair<const std::uint32_t, RunOfClock>* most = nullptr;
    for (const auto& run : runs_) {
      const std::uint64_t count = run.second.positions.count();
      if (count > (most != nullptr ? most->second.positions.count() : 0)) most = &run;
    }
    return most;
  }

 private:
  RunOfClock* run_of(const LogTime& time) {
    if (!log_.slice.contains(time.t_ns)) return nullptr;
    const auto found = runs_.find(time.boot);
    if (found != runs_.end()) return &found->second;
    if (runs_.size() >= kMaxRuns) drop_smallest_run();
    return &runs_.try_emplace(time.boot, max_intervals_).first->second;
  }
  /// The latest of those with the fewest positions. Where streams of a log are read one after the
  /// other, the attitudes of a run that was dropped may be missing.
  void drop_smallest_run() {
    const auto least = std::min_element(runs_.rbegin(), runs_.rend(), [](auto& a, auto& b) {
      return a.second.positions.count() < b.second.positions.count();
    });
    runs_.erase(std::next(least).base());
  }
  void take_position(StreamId id, const LogTime& time, const Eigen::Vector3d& value) override {
    if (id != truth_.position) return;
    const StreamInfo& source = log_.streams[id];
    const bool local = source.description.position == PositionKind::kLocal;
    const std::optional<LocalOrigin>& origin = origin_ ? origin_ : source.first_origin;
    RunOfClock* const run = run_of(time);
    if (run == nullptr) return;
    if (!local) {
      run->add(time.t_ns, value, true);
    } else if (origin) {
      run->add(time.t_ns, geodetic_from_local(*origin, value), true);
    } else {
      run->add(time.t_ns, {value.x(), value.y(), -value.z()}, false);
    }
  }
  void take_attitude(StreamId id,
                     const LogTime& time,
                     const Eigen::Quaterniond& R_ned_body) override {
    if (id != truth_.attitude) return;
    RunOfClock* const run = run_of(time);
    if (run == nullptr) return;
    const RollPitchYaw angles = attitude_from(R_enu_ned() * R_ned_body);
    run->attitudes.add({time.t_ns, {angles.roll_rad, angles.pitch_rad, angles.yaw_rad}});
  }
  void take_invalid(StreamId /*id*/) override {}
  [[nodiscard]] PositionKind position_kind(StreamId id) const override {
    // The pass that opened the log met more streams only if the file has grown since.
    return id < log_.streams.size() ? log_.streams[id].description.position : PositionKind::kNone;
  }

  const OpenedLog& log_;
  const TruthChoice& truth_;
  std::size_t max_intervals_;
  const std::atomic<bool>* cancel_;
  std::optional<LocalOrigin> origin_;
  std::map<std::uint32_t, RunOfClock> runs_;  ///< by boot; those with the most positions
};

}  // namespace

Result<LogSeries> read_log_series(const OpenedLog& log,
                                  const LogSeriesRequest& request,
                                  const std::atomic<bool>* cancel) {
  const Result<TruthChoice> truth = choose_truth(log, request.source);
  if (!truth) return truth.error();
  const StreamInfo& source = log.streams[truth->position];
  SeriesSink sink(log, *truth, request.max_intervals, cancel);
  if (Status status = read_log_into(log, sink); !status) return status.error();
  const auto* const main_run = sink.main_run();
  if (main_run == nullptr) {
    return Error{ErrorCode::kUnreadable,
                 log.file.string() + ": " + source.description.name +
                     ": no valid positions in the time asked for"};
  }
  const RunOfClock* const run = &main_run->second;
  LogSeries series;
  series.vehicle = source.description.vehicle;
  series.run = main_run->first;
  series.position_source = source.description.name;
  if (truth->attitude) series.attitude_source = log.streams[*truth->attitude].description.name;
  series.georeferenced = source.georeferenced;
  series.height = source.description.height;
  series.positions = run->positions.points();
  series.speeds = run->speeds.points();
  series.attitudes = run->attitudes.points();
  series.position_count = run->positions.count();
  series.attitude_count = run->attitudes.count();
  series.steps = run->steps;
  return series;
}

}  // namespace overfly::flight::logs
