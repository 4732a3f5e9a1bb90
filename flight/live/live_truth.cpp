#include "flight/live/live_truth.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <mutex>
#include <utility>

#include "core/text/number_text.hpp"
#include "flight/live/live_doubts.hpp"
#include "flight/live/live_motion.hpp"
#include "flight/live/state_wait.hpp"
#include "flight/live/stop_watch.hpp"
#include "flight/live/truth_streams.hpp"
#include "flight/live/vehicle_reports.hpp"
#include "flight/mavlink/link/frame_recorder.hpp"
#include "flight/mavlink/messages.hpp"

namespace overfly::flight::live {
namespace {

constexpr std::int64_t kNothingKnownNs = std::numeric_limits<std::int64_t>::min();
/// Texts and other instants that a flight records; a vehicle may send any number.
constexpr std::uint64_t kMaxOtherEvents = 1000;

/// 0: not known yet.
std::uint8_t autopilot_of(const mavlink::Vehicle& vehicle) {
  const std::optional<mavlink::Heartbeat> heartbeat = vehicle.state().heartbeat;
  return heartbeat ? heartbeat->autopilot : std::uint8_t{0};
}

}  // namespace

struct LiveTruth::Impl {
  std::shared_ptr<mavlink::Vehicle> vehicle;
  LiveTruthOptions options;

  StateNews news;
  std::unique_ptr<LiveSamples> samples;
  std::uint64_t restarts = 0;  ///< of the vehicle before its flight
  StopWatch stop;
  std::optional<TruthStreams> streams;
  bool started = false;
  /// Once the streams are chosen; moves on until the flight has started.
  std::int64_t start_ns = 0;
  std::string end_reason;              ///< empty while the flight goes on
  std::optional<std::int64_t> end_ns;  ///< of the vehicle's clock
  LiveMotion motion;
  std::string opened_as;  ///< description
  std::shared_ptr<mavlink::FeedbackSender> sender;
  VehicleReports reports;
  bool reported = false;                ///< since the vehicle was restarted
  std::uint64_t other_events = 0;       ///< taken
  std::uint64_t unrecorded_events = 0;  ///< of these, beyond kMaxOtherEvents

  Impl(std::shared_ptr<mavlink::Vehicle> of, const LocalFrame& in, const LiveTruthOptions& with)
      : vehicle(std::move(of)),
        options(with),
        samples(std::make_unique<LiveSamples>(with.geoid_separation_m, autopilot_of(*vehicle))),
        stop(with.stop),
        started(with.start.mission_item < 0),
        motion(in, with.geoid_separation_m, with.gap_limit_ns) {}

  void take(const mavlink::Frame& message);
  [[nodiscard]] std::int64_t known_until_ns() const;
  bool choose();
  void start_over(const mavlink::Frame& message);
  void await_start(const mavlink::Frame& message);
  void end(const std::string& reason);
  [[nodiscard]] AircraftState at(std::int64_t vehicle_ns);
  /// Waits until `ready` returns true or the flight ends.
  Status wait(const std::string& what,
              const std::function<bool()>& ready,
              const std::atomic<bool>* cancel);

  [[nodiscard]] const std::deque<LivePosition>& positions() const {
    return samples->streams()[streams->position].positions;
  }
  [[nodiscard]] const std::deque<LiveAttitude>& attitudes() const {
    return samples->streams()[streams->attitude].attitudes;
  }
};

void LiveTruth::Impl::take(const mavlink::Frame& message) {
  {
    const std::lock_guard lock(news.mutex);
    if (end_ns) return;
    const std::int64_t before_ns = streams ? known_until_ns() : kNothingKnownNs;
    samples->take(message);
    if (samples->restarted() && !(streams && started)) start_over(message);
    if (const auto now_ns = samples->latest_ns()) {
      // The flight may begin with a message that was held: the first report is as early.
      if (!reported) reports.add(*vehicle, *samples->first_ns());
      reported = true;
      reports.add(*vehicle, *now_ns);
    }
    if (!streams) (void)choose();
    if (streams) {
      if (known_until_ns() > before_ns) news.arrivals.add(known_until_ns());
      if (samples->restarted()) {
        end("the vehicle's clock started again: the vehicle was restarted");
      } else if (const std::string reason = stop.take(message); !reason.empty()) {
        end(reason);
      }
      if (!started && !end_ns) await_start(message);
    }
  }
  news.arrived.notify_all();
}

/// The vehicle was restarted before its flight: all that it has sent is forgotten.
/// @param message  the first one that proves it
void LiveTruth::Impl::start_over(const mavlink::Frame& message) {
  ++restarts;
  samples = std::make_unique<LiveSamples>(options.geoid_separation_m, autopilot_of(*vehicle));
  stop = StopWatch(options.stop);
  streams.reset();
  reports = VehicleReports();
  reported = false;
  news.arrivals.restart();
  samples->take(message);
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
  const std::optional<TruthStreams> chosen = choose_streams(*samples, options.truth);
  if (!chosen) return false;
  const LiveStream& position = samples->streams()[chosen->position];
  const LiveStream& attitude = samples->streams()[chosen->attitude];
  const std::int64_t first_ns =
      std::max(position.positions.front().t_ns, attitude.attitudes.front().t_ns);
  // Better streams of the same origin come within the same time.
  const bool best = chosen->simulation && position.description.preference == 0;
  if (!best && samples->latest_ns().value_or(0) - first_ns < options.simulation_wait_ns) {
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
  samples->keep_only(chosen->position, chosen->attitude);
  samples->start_at(start_ns);
  samples->sensors().forget_before(start_ns);
  return true;
}

/// Forgets the flight so far until its start condition holds.
void LiveTruth::Impl::await_start(const mavlink::Frame& message) {
  start_ns = known_until_ns();
  samples->start_at(start_ns);
  samples->sensors().forget_before(start_ns);
  started = message.message_id == static_cast<std::uint32_t>(mavlink::MessageId::kMissionCurrent) &&
            mavlink::decode_mission_sequence(message) >= options.start.mission_item;
}

Status LiveTruth::Impl::wait(const std::string& what,
                             const std::function<bool()>& ready,
                             const std::atomic<bool>* cancel) {
  AwaitedSource source;
  source.name = "the vehicle";
  source.patience = options.patience;
  source.ended = [this] { return end_ns.has_value(); };
  source.full = [this] { return samples->full(); };
  source.missing = [this] {
    return streams ? std::string("no new state") : missing_text(*samples, options.truth);
  };
  source.heard = [this] { return vehicle->last_heard(); };
  return wait_for_states(news, source, what, ready, cancel);
}

/// @pre start_ns <= vehicle_ns <= known_until_ns()
AircraftState LiveTruth::Impl::at(std::int64_t vehicle_ns) {
  samples->forget_before(vehicle_ns);
  news.arrivals.use(vehicle_ns);
  AircraftState state =
      motion.at(positions(), attitudes(), streams->attitude == streams->position, vehicle_ns);
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
  const auto started = [&impl] { return impl.streams.has_value() && impl.started; };
  if (Status status = impl.wait(what, started, cancel); !status) return status.error();
  const std::lock_guard lock(impl.news.mutex);
  if (!impl.started) {
    return Error{ErrorCode::kIo,
                 impl.vehicle->address().text() +
                     ": the flight ended before the mission came to item " +
                     std::to_string(options.start.mission_item) + ": " + impl.end_reason};
  }
  return truth;
}

std::string LiveTruth::description() const {
  const mavlink::VehicleState state = impl_->vehicle->state();
  const std::lock_guard lock(impl_->news.mutex);
  return "live vehicle " + std::to_string(state.system) + "." + std::to_string(state.component) +
         " on " + impl_->vehicle->address().text() + ": " + impl_->opened_as + " from " +
         seconds_shown(impl_->start_ns) + " of its clock";
}

std::vector<std::string> LiveTruth::warnings() const {
  const std::lock_guard lock(impl_->news.mutex);
  std::vector<std::string> warnings = impl_->options.warnings;
  if (impl_->restarts > 0) {
    warnings.push_back("the vehicle was restarted before its flight (" +
                       counted(impl_->restarts, "time") + "): what it had sent was forgotten");
  }
  if (const auto gaps = impl_->motion.gaps_text(impl_->start_ns)) warnings.push_back(*gaps);
  for (std::string& text : texts_of(impl_->samples->doubts(), impl_->start_ns)) {
    warnings.push_back(std::move(text));
  }
  if (impl_->end_ns) {
    warnings.push_back("the flight ended at " + seconds_shown(*impl_->end_ns - impl_->start_ns) +
                       ": " + impl_->end_reason);
  }
  const std::uint64_t lost = impl_->samples->lost_events() + impl_->unrecorded_events;
  if (lost > 0) {
    warnings.push_back(std::to_string(lost) + " events of the vehicle were not recorded: at most " +
                       std::to_string(kMaxOtherEvents) + " texts and other instants are");
  }
  if (impl_->options.recorder) {
    const std::string problem = impl_->options.recorder->problem();
    if (!problem.empty()) warnings.push_back(problem);
  }
  return warnings;
}

std::vector<FlightEvent> LiveTruth::take_events(std::int64_t t_ns) {
  const std::lock_guard lock(impl_->news.mutex);
  std::deque<FlightEvent>& waiting = impl_->samples->events();
  std::vector<FlightEvent> taken;
  std::map<FlightEventKind, FlightEvent> in_force;
  while (!waiting.empty() && waiting.front().t_ns - impl_->start_ns <= t_ns) {
    FlightEvent event = std::move(waiting.front());
    waiting.pop_front();
    event.t_ns -= impl_->start_ns;
    if (event.t_ns >= 0) {
      if (event.kind == FlightEventKind::kOther && ++impl_->other_events > kMaxOtherEvents) {
        ++impl_->unrecorded_events;
        continue;
      }
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
  const std::lock_guard lock(impl_->news.mutex);
  std::optional<VehicleStatus> latest = impl_->reports.take_until(impl_->start_ns + t_ns);
  if (!latest) return std::nullopt;
  latest->t_ns = std::max<std::int64_t>(latest->t_ns - impl_->start_ns, 0);
  latest->gaps = impl_->motion.gap_count();
  return latest;
}

SensorSamples LiveTruth::take_samples(std::int64_t t_ns) {
  const std::lock_guard lock(impl_->news.mutex);
  return impl_->samples->sensors().take_until(impl_->start_ns + t_ns, impl_->start_ns);
}

std::string LiveTruth::sensor_report() const {
  const std::lock_guard lock(impl_->news.mutex);
  return impl_->samples->sensors().report();
}

std::int64_t LiveTruth::start_ns() const { return impl_->start_ns; }

void LiveTruth::send_estimates_by(std::shared_ptr<mavlink::FeedbackSender> sender) {
  impl_->sender = std::move(sender);
}

std::shared_ptr<EstimateReceiver> LiveTruth::estimate_receiver() const { return impl_->sender; }

void LiveTruth::begin() {
  const std::lock_guard lock(impl_->news.mutex);
  if (impl_->end_ns) return;
  impl_->start_ns = impl_->known_until_ns();
  impl_->samples->start_at(impl_->start_ns);
  impl_->news.arrivals.use_latest();
  if (impl_->sender) impl_->sender->start_at(impl_->start_ns);
}

std::optional<std::int64_t> LiveTruth::heard_ns() const {
  const std::lock_guard lock(impl_->news.mutex);
  return impl_->news.arrivals.used_ns();
}

Result<std::optional<AircraftState>> LiveTruth::find_state(std::int64_t t_ns,
                                                           const std::atomic<bool>* cancel) {
  Impl& impl = *impl_;
  if (Status status = check_flight_time(t_ns); !status) return status.error();
  const std::int64_t vehicle_ns = impl.start_ns + t_ns;
  const Status waited = impl.wait(
      "the vehicle's state at " + seconds_shown(t_ns),
      [&impl, vehicle_ns] { return impl.known_until_ns() >= vehicle_ns; },
      cancel);
  if (!waited) return waited.error();
  const std::lock_guard lock(impl.news.mutex);
  if (impl.end_ns && vehicle_ns > *impl.end_ns) return std::optional<AircraftState>();
  return std::optional(impl.at(vehicle_ns));
}

}  // namespace overfly::flight::live
