#include "flight/live/live_truth.hpp"

#include <algorithm>
#include <condition_variable>
#include <cstdio>
#include <map>
#include <mutex>
#include <utility>

#include "core/cancellable_wait.hpp"
#include "core/text/number_text.hpp"
#include "flight/live/stop_watch.hpp"
#include "flight/live/truth_streams.hpp"
#include "flight/logs/ned_attitude.hpp"

namespace overfly::flight::live {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::int64_t kStatusPeriodNs = kNsPerS / 2;

std::string seconds_shown(std::int64_t t_ns) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3f s", s_from_ns(t_ns));
  return text;
}

/// Of samples around a time: the first one not before it. @pre there is one, and it is not the
/// first of all unless its time is t_ns
template <typename Sample>
typename std::deque<Sample>::const_iterator not_before(const std::deque<Sample>& samples,
                                                       std::int64_t t_ns) {
  return std::lower_bound(
      samples.begin(), samples.end(), t_ns, [](const Sample& sample, std::int64_t t) {
        return sample.t_ns < t;
      });
}

}  // namespace

struct LiveTruth::Impl {
  std::shared_ptr<mavlink::Vehicle> vehicle;
  LocalFrame frame;
  LiveTruthOptions options;

  mutable std::mutex mutex;
  std::condition_variable news;
  LiveSamples samples;
  StopWatch stop;
  std::optional<TruthStreams> streams;
  std::int64_t start_ns = 0;
  Clock::time_point last_sample;
  std::string end_reason;              ///< empty while the flight goes on
  std::optional<std::int64_t> end_ns;  ///< of the vehicle's clock
  std::uint64_t gaps = 0;
  std::int64_t longest_gap_ns = 0;
  std::int64_t longest_gap_at_ns = 0;   ///< from the start
  std::int64_t last_gap_begin_ns = -1;  ///< counted already
  std::string opened_as;                ///< description
  std::int64_t next_status_ns = 0;      ///< from the start
  std::int64_t counted_ns = 0;          ///< the vehicle's clock at the last status
  std::uint64_t counted_messages = 0;   ///< until then

  Impl(std::shared_ptr<mavlink::Vehicle> of, const LocalFrame& in, const LiveTruthOptions& with)
      : vehicle(std::move(of)), frame(in), options(with), stop(with.stop) {}

  void take(const mavlink::Frame& message);
  [[nodiscard]] std::int64_t known_until_ns() const;
  bool choose();
  void end(const std::string& reason);
  [[nodiscard]] AircraftState state_of(const LivePosition& position) const;
  [[nodiscard]] AircraftState at(std::int64_t vehicle_ns);
  void set_attitude(std::int64_t vehicle_ns, AircraftState& state);
  void note_gap(std::int64_t begin_ns, std::int64_t end_of_gap_ns);
  [[nodiscard]] Geodetic point_of(const Eigen::Vector3d& geodetic) const;
  template <typename Ready>
  Status wait(const std::string& what, const std::atomic<bool>* cancel, const Ready& ready);

  [[nodiscard]] const std::deque<LivePosition>& positions() const {
    return samples.streams()[streams->position].positions;
  }
  [[nodiscard]] const std::deque<LiveAttitude>& attitudes() const {
    return samples.streams()[streams->attitude].attitudes;
  }
};

void LiveTruth::Impl::take(const mavlink::Frame& message) {
  {
    const std::lock_guard lock(mutex);
    if (end_ns) return;
    const std::int64_t before_ns = streams ? known_until_ns() : 0;
    samples.take(message);
    if (!streams && choose()) last_sample = Clock::now();
    if (streams) {
      if (known_until_ns() > before_ns) last_sample = Clock::now();
      if (samples.restarted()) {
        end("the vehicle's clock started again: the vehicle was restarted");
      } else if (const std::string reason = stop.take(message); !reason.empty()) {
        end(reason);
      }
    }
  }
  news.notify_all();
}

void LiveTruth::Impl::end(const std::string& reason) {
  end_reason = reason;
  end_ns = known_until_ns();
}

/// The time up to which position and attitude are known. @pre the streams are chosen
std::int64_t LiveTruth::Impl::known_until_ns() const {
  return std::min(positions().back().t_ns, attitudes().back().t_ns);
}

/// Chooses the streams once the best ones have had time to come. @return whether it did
bool LiveTruth::Impl::choose() {
  const std::optional<TruthStreams> chosen = choose_streams(samples, options.truth);
  if (!chosen) return false;
  const LiveStream& position = samples.streams()[chosen->position];
  const LiveStream& attitude = samples.streams()[chosen->attitude];
  const std::int64_t first_ns =
      std::max(position.positions.front().t_ns, attitude.attitudes.front().t_ns);
  // Better streams of the same origin come within the same time.
  const bool best = chosen->simulation && position.description.preference == 0;
  if (!best && samples.latest_ns().value_or(0) - first_ns < options.simulation_wait_ns) {
    return false;
  }
  if (std::min(position.positions.back().t_ns, attitude.attitudes.back().t_ns) < first_ns) {
    return false;
  }
  opened_as = std::string(chosen->simulation ? "the simulator's state (" : "the estimate (") +
              position.description.name;
  if (chosen->attitude != chosen->position) opened_as += ", " + attitude.description.name;
  opened_as += ")";
  streams = chosen;
  start_ns = first_ns;
  samples.keep_only(chosen->position, chosen->attitude);
  samples.forget_before(start_ns);
  return true;
}

/// Waits until `ready` returns true or the flight ends.
template <typename Ready>
Status LiveTruth::Impl::wait(const std::string& what,
                             const std::atomic<bool>* cancel,
                             const Ready& ready) {
  std::unique_lock lock(mutex);
  const Clock::time_point begin = Clock::now();
  while (!ready() && !end_ns) {
    if (is_cancelled(cancel)) return cancelled("the vehicle");
    if (samples.full()) {
      return Error{ErrorCode::kIo,
                   what + ": the run is more than " + std::to_string(kMaxLiveSamples) +
                       " samples behind the vehicle"};
    }
    // Patience counts from the later of the last sample and the begin of the wait: a run that has
    // paused must not blame the vehicle.
    const Clock::time_point quiet_since = std::max(last_sample, begin);
    if (Clock::now() - quiet_since >= options.patience) {
      const double patience_s = std::chrono::duration<double>(options.patience).count();
      const std::string missing = streams ? "no new state within " + number_text(patience_s) + " s"
                                          : missing_text(samples, options.truth) + " within " +
                                                number_text(patience_s) + " s";
      lock.unlock();
      return Error{ErrorCode::kIo, what + ": " + missing + ": " + vehicle->last_heard()};
    }
    news.wait_for(lock, kCancelPeriod);
  }
  return {};
}

Geodetic LiveTruth::Impl::point_of(const Eigen::Vector3d& geodetic) const {
  return geodetic_from_deg(geodetic.x(), geodetic.y(), geodetic.z() + options.geoid_separation_m);
}

/// Position and velocity of a sample in the world frame.
AircraftState LiveTruth::Impl::state_of(const LivePosition& position) const {
  const Geodetic point = point_of(position.geodetic);
  AircraftState state;
  state.t_ns = position.t_ns;
  state.T_world_body.translation = frame.world_from_geodetic(point);
  state.v_body_world_m_s = frame.R_world_enu_at(point) * (logs::R_enu_ned() * position.v_ned_m_s);
  state.airspeed_m_s =
      position.airspeed_m_s >= 0.0 ? position.airspeed_m_s : state.v_body_world_m_s.norm();
  return state;
}

void LiveTruth::Impl::note_gap(std::int64_t begin_ns, std::int64_t end_of_gap_ns) {
  const std::int64_t gap_ns = end_of_gap_ns - begin_ns;
  if (gap_ns <= options.gap_limit_ns || begin_ns <= last_gap_begin_ns) return;
  last_gap_begin_ns = begin_ns;
  ++gaps;
  if (gap_ns <= longest_gap_ns) return;
  longest_gap_ns = gap_ns;
  longest_gap_at_ns = begin_ns - start_ns;
}

void LiveTruth::Impl::set_attitude(std::int64_t vehicle_ns, AircraftState& state) {
  const auto after = not_before(attitudes(), vehicle_ns);
  const LiveAttitude& b = *after;
  const LiveAttitude& a = b.t_ns == vehicle_ns ? b : *std::prev(after);
  Eigen::Quaterniond R_ned_body = b.R_ned_body;
  Eigen::Vector3d rate_rad_s = b.rate_rad_s;
  if (a.t_ns != b.t_ns) {
    // Of one stream the gap of the positions is the same.
    if (streams->attitude != streams->position) note_gap(a.t_ns, b.t_ns);
    const double dt_s = s_from_ns(b.t_ns - a.t_ns);
    const double part = s_from_ns(vehicle_ns - a.t_ns) / dt_s;
    R_ned_body = a.R_ned_body.slerp(part, b.R_ned_body);
    if (a.has_rate && b.has_rate) {
      rate_rad_s = (1.0 - part) * a.rate_rad_s + part * b.rate_rad_s;
    } else {
      Eigen::Quaterniond step = a.R_ned_body.conjugate() * b.R_ned_body;
      if (step.w() < 0.0) step.coeffs() = -step.coeffs();
      const Eigen::AngleAxisd turn(step);
      rate_rad_s = turn.axis() * (turn.angle() / dt_s);
    }
  }
  const Geodetic point = frame.geodetic_from_world(state.T_world_body.translation);
  state.T_world_body.rotation =
      (frame.R_world_enu_at(point) * logs::R_enu_ned() * R_ned_body).normalized();
  state.omega_body_rad_s = rate_rad_s;
}

/// @pre start_ns <= vehicle_ns <= known_until_ns()
AircraftState LiveTruth::Impl::at(std::int64_t vehicle_ns) {
  samples.forget_before(vehicle_ns);
  const auto after = not_before(positions(), vehicle_ns);
  AircraftState state;
  if (after->t_ns == vehicle_ns) {
    state = state_of(*after);
  } else {
    const auto before = std::prev(after);
    note_gap(before->t_ns, after->t_ns);
    AircraftState a = state_of(*before);
    AircraftState b = state_of(*after);
    if (!before->has_velocity || !after->has_velocity) {
      a.v_body_world_m_s = b.v_body_world_m_s =
          (b.T_world_body.translation - a.T_world_body.translation) / s_from_ns(b.t_ns - a.t_ns);
    }
    state = interpolate(a, b, vehicle_ns);
  }
  set_attitude(vehicle_ns, state);
  state.t_ns = vehicle_ns - start_ns;
  return state;
}

LiveTruth::LiveTruth(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

LiveTruth::~LiveTruth() { impl_->vehicle->set_listener({}); }

Result<std::unique_ptr<LiveTruth>> LiveTruth::open(std::shared_ptr<mavlink::Vehicle> vehicle,
                                                   const LocalFrame& frame,
                                                   const LiveTruthOptions& options,
                                                   const std::atomic<bool>* cancel) {
  std::unique_ptr<LiveTruth> truth(
      new LiveTruth(std::make_unique<Impl>(std::move(vehicle), frame, options)));
  Impl& impl = *truth->impl_;
  impl.vehicle->set_listener([&impl](const mavlink::Frame& message) { impl.take(message); });
  const std::string what = impl.vehicle->address().text() + ": waiting for the flight's start";
  if (Status status = impl.wait(what, cancel, [&impl] { return impl.streams.has_value(); });
      !status) {
    return status.error();
  }
  return truth;
}

std::string LiveTruth::description() const {
  const mavlink::VehicleState state = impl_->vehicle->state();
  const std::lock_guard lock(impl_->mutex);
  return "live vehicle " + std::to_string(state.system) + "." + std::to_string(state.component) +
         " on " + impl_->vehicle->address().text() + ": " + impl_->opened_as;
}

std::vector<std::string> LiveTruth::warnings() const {
  const std::lock_guard lock(impl_->mutex);
  std::vector<std::string> warnings;
  if (impl_->gaps > 0) {
    warnings.push_back(std::to_string(impl_->gaps) + " gaps between samples are longer than " +
                       seconds_shown(impl_->options.gap_limit_ns) +
                       " and were interpolated; the longest one, at " +
                       seconds_shown(impl_->longest_gap_at_ns) + ", is " +
                       seconds_shown(impl_->longest_gap_ns) + " long");
  }
  if (impl_->end_ns) {
    warnings.push_back("the flight ended at " + seconds_shown(*impl_->end_ns - impl_->start_ns) +
                       ": " + impl_->end_reason);
  }
  return warnings;
}

std::vector<FlightEvent> LiveTruth::take_events(std::int64_t t_ns) {
  const std::lock_guard lock(impl_->mutex);
  std::deque<FlightEvent>& waiting = impl_->samples.events();
  std::vector<FlightEvent> taken;
  std::map<FlightEventKind, FlightEvent> in_force;
  while (!waiting.empty() && waiting.front().t_ns - impl_->start_ns <= t_ns) {
    FlightEvent event = std::move(waiting.front());
    waiting.pop_front();
    event.t_ns -= impl_->start_ns;
    if (event.t_ns >= 0) {
      taken.push_back(std::move(event));
    } else if (event.kind != FlightEventKind::kOther) {
      event.t_ns = 0;
      in_force[event.kind] = std::move(event);
    }
  }
  for (auto& [kind, event] : in_force) taken.insert(taken.begin(), std::move(event));
  return taken;
}

std::optional<VehicleStatus> LiveTruth::take_status(std::int64_t t_ns) {
  Impl& impl = *impl_;
  if (t_ns < impl.next_status_ns) return std::nullopt;
  const mavlink::VehicleState state = impl.vehicle->state();
  VehicleStatus status;
  status.t_ns = t_ns;
  status.vehicle = std::to_string(state.system) + "." + std::to_string(state.component);
  if (const auto mode = logs::flight_event_of(logs::EventKind::kMode, state.mode)) {
    status.mode = mode->text;
  }
  if (state.heartbeat) status.armed = state.armed();
  status.battery_v = state.battery_v;
  status.battery_percent = state.battery_percent;
  if (state.gps) {
    status.gps_fix = state.gps->fix_type;
    // 255 stands for unknown.
    if (state.gps->satellites != 255) status.satellites = state.gps->satellites;
  }
  // The first status has nothing to count from.
  const std::int64_t boot_ns = state.boot_ns.value_or(0);
  if (impl.counted_ns > 0 && boot_ns > impl.counted_ns) {
    status.messages_per_s = static_cast<double>(state.messages - impl.counted_messages) /
                            s_from_ns(boot_ns - impl.counted_ns);
  }
  impl.counted_ns = boot_ns;
  impl.counted_messages = state.messages;
  status.lost_messages = state.lost_messages;
  const auto sent = static_cast<double>(state.messages + state.lost_messages);
  if (sent > 0.0) status.lost_percent = 100.0 * static_cast<double>(state.lost_messages) / sent;
  if (const auto clock = impl.vehicle->clock()) {
    status.clock_rate = clock->rate;
    status.round_trip_ms = static_cast<double>(clock->round_trip_ns) * 1e-6;
  }
  const std::lock_guard lock(impl.mutex);
  status.gaps = impl.gaps;
  impl.next_status_ns = (t_ns / kStatusPeriodNs + 1) * kStatusPeriodNs;
  return status;
}

std::int64_t LiveTruth::start_ns() const { return impl_->start_ns; }

Result<std::optional<AircraftState>> LiveTruth::find_state(std::int64_t t_ns,
                                                           const std::atomic<bool>* cancel) {
  Impl& impl = *impl_;
  constexpr std::int64_t kLongestFlightNs = 366LL * 86400 * kNsPerS;
  if (t_ns < 0 || t_ns > kLongestFlightNs) {
    return Error{ErrorCode::kInvalidArgument,
                 "t_ns = " + std::to_string(t_ns) + ": must be in [0, " +
                     std::to_string(kLongestFlightNs) + "]"};
  }
  const std::int64_t vehicle_ns = impl.start_ns + t_ns;
  const Status waited =
      impl.wait("the vehicle's state at " + seconds_shown(t_ns), cancel, [&impl, vehicle_ns] {
        return impl.known_until_ns() >= vehicle_ns;
      });
  if (!waited) return waited.error();
  const std::lock_guard lock(impl.mutex);
  if (impl.end_ns && vehicle_ns > *impl.end_ns) return std::optional<AircraftState>();
  return std::optional(impl.at(vehicle_ns));
}

}  // namespace overfly::flight::live
