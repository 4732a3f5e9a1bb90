#include "flight/autopilot/mission_flight.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "core/text/number_text.hpp"
#include "core/time.hpp"
#include "flight/dynamics/trim.hpp"

namespace overfly::autopilot {
namespace {

constexpr double kLaunchHeightM = 1.5;
constexpr std::int64_t kStepNs = static_cast<std::int64_t>(1e9 / kControlRateHz);
constexpr std::int64_t kPartNs = static_cast<std::int64_t>(1e9 / kMotionRateHz);

Status check_setup(const MissionSetup& setup) {
  if (Status status = check(setup.parameters); !status) return status;
  if (Status status = check(setup.mission); !status) return status;
  if (const double wind = setup.wind_world_m_s.head<2>().norm();
      !(wind < setup.parameters.airspeed_cruise)) {
    return Error{ErrorCode::kInvalidArgument,
                 "wind.speed_m_s = " + number_text(wind) + ": must be below the airspeed of " +
                     number_text(setup.parameters.airspeed_cruise) + " m/s"};
  }
  if (!(setup.duration_max_s > 0.0 && setup.duration_max_s <= kFlightMaxS)) {
    return Error{ErrorCode::kInvalidArgument,
                 "duration_max_s = " + number_text(setup.duration_max_s) + ": must be in (0, " +
                     number_text(kFlightMaxS) + "]"};
  }
  if (setup.mission.items.front().command == MissionCommand::kTakeOff && setup.start_world_m) {
    return Error{ErrorCode::kInvalidArgument,
                 "mission item 1: a take-off is flown from the ground, not from a start in flight"};
  }
  return {};
}

/// An aircraft in level flight.
Result<dynamics::Aircraft> in_flight(const dynamics::AircraftSetup& aircraft,
                                     double airspeed_m_s,
                                     const Eigen::Vector3d& position_world_m,
                                     double heading_rad) {
  const Result<dynamics::Trim> level =
      dynamics::trim(aircraft.airframe,
                     aircraft.environment,
                     {.airspeed_m_s = airspeed_m_s, .up_m = position_world_m.z()});
  if (!level) return level.error();
  return dynamics::Aircraft::create(
      aircraft,
      level->state(position_world_m, heading_rad, aircraft.wind_world_m_s),
      level->controls);
}

Result<dynamics::Aircraft> start_of_flight(const MissionSetup& setup) {
  const dynamics::AircraftSetup aircraft{.airframe = setup.airframe,
                                         .environment = setup.environment,
                                         .wind_world_m_s = setup.wind_world_m_s,
                                         .turbulence = setup.turbulence,
                                         .turbulence_seed = setup.seed};
  if (!setup.start_world_m) {
    return launch(aircraft, setup.parameters, setup.mission.home_world_m, setup.heading_rad);
  }
  return in_flight(
      aircraft, setup.parameters.airspeed_cruise, *setup.start_world_m, setup.heading_rad);
}

/// The item as the mission's file numbers it; the last one when the mission is done.
std::string item_text(const MissionFlight& flight) {
  const std::vector<MissionItem>& items = flight.setup().mission.items;
  const std::size_t item = std::min(flight.autopilot().pilot().item(), items.size() - 1);
  return "mission item " + std::to_string(items[item].number);
}

std::string end_warning(const MissionFlight& flight) {
  const Eigen::Vector3d& at = flight.aircraft().state().position_world_m;
  const std::string when =
      " after " + number_text(std::round(s_from_ns(flight.t_ns()) * 10.0) / 10.0) + " s at east " +
      number_text(std::round(at.x())) + " m, north " + number_text(std::round(at.y())) + " m";
  const MissionPilot& pilot = flight.autopilot().pilot();
  switch (flight.end().value_or(FlightEnd::kTimeLimit)) {
    case FlightEnd::kHitGround:
      return "the aircraft hit the ground" + when + " (" + item_text(flight) + ", " +
             name_of(pilot.phase()) + ")";
    case FlightEnd::kTimeLimit:
      // A shorter flight was asked for.
      if (flight.setup().duration_max_s < kFlightMaxS) return {};
      return "the time limit ended the flight" + when + " in " + item_text(flight) +
             ", the last is " + std::to_string(flight.setup().mission.items.back().number);
    default:
      return {};
  }
}

class MissionTruth final : public TruthSource {
 public:
  MissionTruth(MissionFlight flight, std::int64_t duration_ns, std::string warning)
      : flight_(std::move(flight)), duration_ns_(duration_ns), warning_(std::move(warning)) {
    note_changes();
  }

  [[nodiscard]] std::optional<std::int64_t> duration_ns() const override { return duration_ns_; }
  [[nodiscard]] std::string description() const override {
    const MissionSetup& setup = flight_.setup();
    std::string text = setup.title + ", " + setup.airframe.name;
    if (const double wind = setup.wind_world_m_s.norm(); wind > 0.0) {
      text += ", wind " + number_text(std::round(wind * 10.0) / 10.0) + " m/s";
    }
    constexpr std::array kLevels{"light", "moderate", "severe"};
    if (setup.turbulence) {
      text +=
          std::string(", ") + kLevels[static_cast<std::size_t>(*setup.turbulence)] + " turbulence";
    }
    return text;
  }
  [[nodiscard]] std::vector<std::string> warnings() const override {
    std::vector<std::string> all = flight_.setup().warnings;
    if (!warning_.empty()) all.push_back(warning_);
    return all;
  }
  [[nodiscard]] std::vector<FlightEvent> take_events(std::int64_t t_ns) override {
    std::vector<FlightEvent> taken;
    while (!events_.empty() && events_.front().t_ns <= t_ns) {
      taken.push_back(std::move(events_.front()));
      events_.pop_front();
    }
    return taken;
  }

 private:
  [[nodiscard]] Result<std::optional<AircraftState>> find_state(
      std::int64_t t_ns, const std::atomic<bool>* cancel) override {
    if (t_ns < 0 || t_ns < flight_.t_ns() - kStepNs) {
      return Error{ErrorCode::kInvalidArgument,
                   "t_ns = " + std::to_string(t_ns) + ": times of a flight must not decrease"};
    }
    if (t_ns > duration_ns_) return std::optional<AircraftState>();
    while (flight_.t_ns() < t_ns) {
      if (cancel != nullptr && cancel->load()) {
        return Error{ErrorCode::kCancelled, "the flight was cancelled"};
      }
      if (Status status = flight_.step(); !status) return status.error();
      note_changes();
    }
    return std::optional(flight_.state_at(t_ns));
  }

  /// A new phase of the flight or item of the mission is an event.
  void note_changes() {
    if (!flight_.setup().report_items) return;
    const MissionPilot& pilot = flight_.autopilot().pilot();
    if (phase_ != pilot.phase() && pilot.phase() != FlightPhase::kDone) {
      events_.push_back({flight_.t_ns(), FlightEventKind::kMode, name_of(pilot.phase())});
    }
    phase_ = pilot.phase();
    const bool flown = pilot.item() < flight_.setup().mission.items.size();
    if (item_ != pilot.item() && flown) {
      events_.push_back({flight_.t_ns(), FlightEventKind::kMissionItem, item_text(flight_)});
    }
    item_ = pilot.item();
  }

  MissionFlight flight_;
  std::int64_t duration_ns_;
  std::string warning_;
  std::optional<FlightPhase> phase_;
  std::optional<std::size_t> item_;
  std::deque<FlightEvent> events_;  ///< not taken yet
};

}  // namespace

double ground_smoothing_m(double airspeed_m_s) { return std::max(40.0, 1.6 * airspeed_m_s); }

Result<dynamics::Aircraft> launch(const dynamics::AircraftSetup& aircraft,
                                  const Parameters& parameters,
                                  const Eigen::Vector3d& place_world_m,
                                  double heading_rad) {
  const Eigen::Vector3d position = place_world_m + Eigen::Vector3d(0.0, 0.0, kLaunchHeightM);
  const double stall =
      dynamics::stall_speed_m_s(aircraft.airframe, aircraft.environment, position.z());
  return in_flight(aircraft,
                   std::min(parameters.airspeed_cruise, kLaunchOverStall * stall),
                   position,
                   heading_rad);
}

MissionFlight::MissionFlight(std::shared_ptr<const MissionSetup> setup,
                             std::shared_ptr<const HeightQuery> ground,
                             std::shared_ptr<SmoothGround> smooth,
                             dynamics::Aircraft aircraft)
    : setup_(std::move(setup)),
      ground_(std::move(ground)),
      smooth_(std::move(smooth)),
      aircraft_(std::move(aircraft)),
      autopilot_(setup_->parameters,
                 setup_->airframe,
                 setup_->environment,
                 setup_->mission,
                 [smooth = smooth_](const Eigen::Vector2d& at) { return smooth->up_m(at); }) {
  autopilot_.start(flight_state(aircraft_), aircraft_.positions());
  states_.fill(aircraft_.truth(0));
}

Result<MissionFlight> MissionFlight::create(const MissionSetup& setup,
                                            std::shared_ptr<const HeightQuery> ground) {
  if (!ground) {
    return Error{ErrorCode::kInvalidArgument, "a mission requires a ground (height query)"};
  }
  if (Status status = check_setup(setup); !status) return status.error();
  Result<dynamics::Aircraft> aircraft = start_of_flight(setup);
  if (!aircraft) return aircraft.error();
  auto smooth =
      std::make_shared<SmoothGround>(ground, ground_smoothing_m(setup.parameters.airspeed_cruise));
  MissionFlight flight(std::make_shared<const MissionSetup>(setup),
                       std::move(ground),
                       std::move(smooth),
                       std::move(aircraft).value());
  if (Status status = flight.check_ground(); !status) return status.error();
  return flight;
}

std::int64_t MissionFlight::t_ns() const { return steps_ * kStepNs; }

Status MissionFlight::check_ground() {
  const Eigen::Vector3d& at = aircraft_.state().position_world_m;
  const double ground_m = ground_->ground_up_m(at.x(), at.y());
  if (!std::isfinite(ground_m)) {
    return Error{ErrorCode::kInvalidArgument,
                 "the ground's height at east " + number_text(at.x()) + " m, north " +
                     number_text(at.y()) + " m is not finite"};
  }
  if (at.z() > ground_m) return {};
  end_ = autopilot_.pilot().phase() == FlightPhase::kFlare ? FlightEnd::kLanded
                                                           : FlightEnd::kHitGround;
  return {};
}

Status MissionFlight::step() {
  if (end_) return {};
  const dynamics::Controls commands = autopilot_.update(flight_state(aircraft_));
  states_.front() = states_.back();
  for (int part = 1; part <= kParts; ++part) {
    if (Status status = aircraft_.step(commands, 1.0 / kMotionRateHz); !status) return status;
    states_[part] = aircraft_.truth(t_ns() + part * kPartNs);
  }
  ++steps_;
  if (Status status = check_ground(); !status) return status;
  if (end_) return {};
  if (autopilot_.pilot().phase() == FlightPhase::kDone) end_ = FlightEnd::kMissionDone;
  if (s_from_ns(t_ns()) >= setup_->duration_max_s) end_ = FlightEnd::kTimeLimit;
  return {};
}

AircraftState MissionFlight::state_at(std::int64_t t_ns) const {
  const std::int64_t into_ns = std::clamp<std::int64_t>(
      t_ns - states_.front().t_ns, 0, states_.back().t_ns - states_.front().t_ns);
  const auto part = static_cast<std::size_t>(std::min<std::int64_t>(into_ns / kPartNs, kParts - 1));
  const AircraftState& before = states_[part];
  const AircraftState& after = states_[part + 1];
  if (after.t_ns <= before.t_ns) return before;  // at the start
  return interpolate(before, after, std::clamp(t_ns, before.t_ns, after.t_ns));
}

Result<std::unique_ptr<TruthSource>> fly_mission(const MissionSetup& setup,
                                                 std::shared_ptr<const HeightQuery> ground,
                                                 const std::atomic<bool>* cancel) {
  Result<MissionFlight> first = MissionFlight::create(setup, ground);
  if (!first) return first.error();
  MissionFlight flight = std::move(first).value();
  while (!flight.end()) {
    if (cancel != nullptr && cancel->load()) {
      return Error{ErrorCode::kCancelled, "the flight was cancelled"};
    }
    if (Status status = flight.step(); !status) return status.error();
  }
  Result<MissionFlight> again = MissionFlight::create(setup, std::move(ground));
  if (!again) return again.error();
  return std::unique_ptr<TruthSource>(
      std::make_unique<MissionTruth>(std::move(again).value(), flight.t_ns(), end_warning(flight)));
}

}  // namespace overfly::autopilot
