#include "flight/vehicle/simulated_vehicle.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/earth/magnetic_field.hpp"
#include "core/motion/pose.hpp"
#include "flight/autopilot/mission_flight.hpp"

namespace overfly::vehicle {
namespace {

using flight::mavlink::MessageId;
using flight::mavlink::PayloadWriter;

/// Of the magnetic field: 2026-01-01T00:00:00Z.
constexpr std::int64_t kFieldDateUnixNs = 1'767'225'600'000'000'000;

}  // namespace

Result<std::unique_ptr<SimulatedVehicle>> SimulatedVehicle::create(const VehicleSetup& setup) {
  Result<autopilot::Parameters> parameters =
      autopilot::tuned_for(setup.airframe,
                           dynamics::Environment::at(setup.home, setup.home.alt_ellipsoid_m),
                           setup.airspeed_m_s,
                           0.0);
  if (!parameters) return parameters.error();
  return std::unique_ptr<SimulatedVehicle>(new SimulatedVehicle(setup, *parameters));
}

SimulatedVehicle::SimulatedVehicle(const VehicleSetup& setup,
                                   const autopilot::Parameters& parameters)
    : setup_(setup),
      parameters_(setup.system, parameters),
      frame_(setup.home),
      field_ned_ut_(MagneticField(kFieldDateUnixNs).ned_ut(setup.home)),
      missions_(setup.system,
                [this](const MissionStore::Items& items) { return check_mission(items); }),
      parked_heading_rad_(setup.heading_rad) {}

Result<autopilot::PlannedMission> SimulatedVehicle::plan(MissionStore::Items items) const {
  // As ArduPlane: item 0 of an upload does not move home.
  items.front().x = deg_from_rad(setup_.home.lat_rad);
  items.front().y = deg_from_rad(setup_.home.lon_rad);
  items.front().z = static_cast<float>(setup_.home.alt_ellipsoid_m);
  return autopilot::plan_mission(items, frame_, ground_, std::nullopt);
}

Status SimulatedVehicle::check_mission(const MissionStore::Items& items) const {
  const auto planned = plan(items);
  if (!planned) return planned.error();
  return {};
}

VehicleReport SimulatedVehicle::report() const {
  VehicleReport report;
  report.boot_ns = now_ns_;
  report.mode = mode_;
  report.armed = armed_;
  report.in_air = aircraft_.has_value();
  report.frame = frame_;
  report.field_ned_ut = field_ned_ut_;
  report.mission_items = static_cast<std::uint16_t>(missions_.items().size());
  if (aircraft_) {
    report.state = autopilot::flight_state(*aircraft_);
    report.throttle = aircraft_->positions().throttle;
  } else {
    report.state.position_world_m = parked_m_;
    report.state.attitude.yaw_rad = wrap_pi(parked_heading_rad_);
    report.state.gravity_m_s2 = dynamics::kStandardGravityMS2;
    report.state.specific_force_body_m_s2 = {0.0, 0.0, -dynamics::kStandardGravityMS2};
  }
  report.height_above_home_m = report.state.position_world_m.z();
  const std::size_t item =
      autopilot_ && mode_ == Mode::kAuto ? autopilot_->pilot().item() : resume_item_;
  if (mode_ == Mode::kAuto && item < flown_.items.size()) {
    report.mission_item = flown_.items[item].number;
  }
  return report;
}

void SimulatedVehicle::say(const std::string& text, Severity severity, const Send& send) {
  text_number_ = text_number_ == 0xFFFF ? 1 : static_cast<std::uint16_t>(text_number_ + 1);
  send_text(text, severity, text_number_, send);
}

void SimulatedVehicle::follow(autopilot::Mission mission, std::size_t item) {
  flown_ = std::move(mission);
  autopilot_.emplace(parameters_.values(),
                     setup_.airframe,
                     aircraft_->environment(),
                     flown_,
                     [](const Eigen::Vector2d&) { return 0.0; });
  autopilot_->start(autopilot::flight_state(*aircraft_), aircraft_->positions(), item);
}

void SimulatedVehicle::circle(const Eigen::Vector3d& centre_m) {
  autopilot::MissionItem item;
  item.command = autopilot::MissionCommand::kLoiter;
  item.position_m = centre_m.head<2>();
  item.height_m = centre_m.z();
  follow({.home_world_m = Eigen::Vector3d::Zero(), .items = {item}}, 0);
}

Status SimulatedVehicle::fly_mission(std::size_t item) {
  if (missions_.items().empty()) return Error{ErrorCode::kConflict, "AUTO: there is no mission"};
  Result<autopilot::PlannedMission> planned = plan(missions_.items());
  if (!planned) return planned.error();
  if (aircraft_) {
    const std::size_t last = planned->mission.items.size() - 1;
    follow(std::move(planned->mission), std::min(item, last));
    return {};
  }
  if (planned->mission.items.front().command != autopilot::MissionCommand::kTakeOff) {
    return Error{ErrorCode::kConflict, "AUTO: the mission has no take-off"};
  }
  const dynamics::Environment environment =
      dynamics::Environment::at(setup_.home, setup_.home.alt_ellipsoid_m);
  Result<dynamics::Aircraft> aircraft =
      autopilot::launch({.airframe = setup_.airframe,
                         .environment = environment,
                         .wind_world_m_s = setup_.wind_world_m_s,
                         .turbulence = setup_.turbulence,
                         .turbulence_seed = setup_.seed + flights_},
                        parameters_.values(),
                        parked_m_,
                        parked_heading_rad_);
  if (!aircraft) return aircraft.error();
  aircraft_ = std::move(*aircraft);
  ++flights_;
  resume_item_ = 0;
  follow(std::move(planned->mission), 0);
  return {};
}

/// The flight has ended: the aircraft stands, disarmed, on the ground below where it was.
void SimulatedVehicle::park(const std::string& text, Severity severity, const Send& send) {
  const autopilot::FlightState state = autopilot::flight_state(*aircraft_);
  parked_m_ = {state.position_world_m.x(), state.position_world_m.y(), 0.0};
  parked_heading_rad_ = state.attitude.yaw_rad;
  aircraft_.reset();
  autopilot_.reset();
  resume_item_ = 0;
  armed_ = false;
  mode_ = Mode::kManual;
  say(text, severity, send);
}

/// Contact with the ground, or the end of the mission.
void SimulatedVehicle::finish_flight(const Send& send) {
  const autopilot::FlightPhase phase = autopilot_->pilot().phase();
  if (aircraft_->state().position_world_m.z() <= 0.0) {
    if (phase == autopilot::FlightPhase::kFlare) return park("Landed", Severity::kInfo, send);
    return park("Crashed: hit the ground", Severity::kCritical, send);
  }
  if (phase == autopilot::FlightPhase::kDone && mode_ == Mode::kAuto) {
    say("Mission complete, changing mode to RTL", Severity::kInfo, send);
    (void)change_mode(Mode::kReturn, send);  // in flight it is always accepted
  }
}

Status SimulatedVehicle::move(const dynamics::Controls& commands) {
  constexpr int kParts = 4;
  for (int i = 0; i < kParts; ++i) {
    if (Status status = aircraft_->step(commands, 1e-9 * kStepNs / kParts); !status) return status;
  }
  return {};
}

void SimulatedVehicle::step(const Send& send) {
  now_ns_ += kStepNs;
  if (armed_ && !aircraft_ && mode_ == Mode::kAuto) {
    if (Status status = fly_mission(0); !status) {
      say(status.error().message, Severity::kWarning, send);
      mode_ = Mode::kManual;
    }
  }
  if (aircraft_) {
    const std::size_t before = autopilot_->pilot().item();
    const dynamics::Controls commands = autopilot_->update(autopilot::flight_state(*aircraft_));
    const Status moved = move(commands);
    const std::size_t after = autopilot_->pilot().item();
    if (after != before && mode_ == Mode::kAuto && before < flown_.items.size()) {
      send(MessageId::kMissionItemReached, PayloadWriter(2).put(0, flown_.items[before].number), 0);
    }
    if (moved) {
      finish_flight(send);
    } else {
      park("Crashed: " + moved.error().message, Severity::kCritical, send);
    }
  }
  missions_.step(now_ns_, send);
  const VehicleReport now = report();
  schedule_.step(now_ns_, [&](MessageId id) {
    if (const auto payload = payload_of(id, now)) send(id, *payload, 0);
  });
}

}  // namespace overfly::vehicle
