#include "flight/vehicle/simulated_vehicle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/motion/pose.hpp"
#include "flight/autopilot/mission_flight.hpp"

namespace overfly::vehicle {
namespace {

using flight::mavlink::MessageId;
using flight::mavlink::PayloadReader;
using flight::mavlink::PayloadWriter;

/// MAV_RESULT.
enum : std::uint8_t {
  kResultAccepted = 0,
  kResultDenied = 2,
  kResultUnsupported = 3,
  kResultFailed = 4
};
/// MAV_CMD.
enum : std::uint16_t {
  kNavLoiterUnlimited = 17,
  kNavReturn = 20,
  kDoSetMode = 176,
  kDoReposition = 192,
  kMissionStart = 300,
  kArmDisarm = 400,
  kGetHomePosition = 410,
  kSetMessageInterval = 511,
  kRequestMessage = 512,
  kRequestCapabilities = 520,
};
/// MAV_SEVERITY.
enum : std::uint8_t { kCritical = 2, kWarning = 4, kInfo = 6 };

constexpr std::uint8_t kReal32 = 9;  // MAV_PARAM_TYPE
constexpr std::int64_t kShortestIntervalNs = 10'000'000;

constexpr std::int64_t interval_of(double rate_hz) {
  return static_cast<std::int64_t>(1e9 / rate_hz);
}

/// Rates of a vehicle that nobody has asked for others [Hz].
constexpr std::array kDefaultRates{
    std::pair{MessageId::kHeartbeat, 1.0},
    std::pair{MessageId::kSysStatus, 1.0},
    std::pair{MessageId::kGpsRawInt, 5.0},
    std::pair{MessageId::kAttitude, 10.0},
    std::pair{MessageId::kGlobalPositionInt, 10.0},
    std::pair{MessageId::kLocalPositionNed, 4.0},
    std::pair{MessageId::kVfrHud, 4.0},
    std::pair{MessageId::kMissionCurrent, 1.0},
    std::pair{MessageId::kExtendedSysState, 1.0},
    std::pair{MessageId::kSimState, 10.0},
    std::pair{MessageId::kAttitudeQuaternion, 0.0},
};

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
      parameters_(parameters),
      frame_(setup.home),
      missions_(setup.system,
                [this](const MissionStore::Items& items) { return check_mission(items); }),
      parked_heading_rad_(setup.heading_rad) {
  for (const auto& [id, rate_hz] : kDefaultRates) {
    due_[id].interval_ns = rate_hz > 0.0 ? interval_of(rate_hz) : 0;
  }
}

Status SimulatedVehicle::check_mission(const MissionStore::Items& items) const {
  const auto planned = autopilot::plan_mission(items, frame_, ground_, std::nullopt);
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
  const std::size_t item =
      autopilot_ && mode_ == Mode::kAuto ? autopilot_->pilot().item() : resume_item_;
  if (mode_ == Mode::kAuto && item < flown_.items.size()) {
    report.mission_item = flown_.items[item].number;
  }
  return report;
}

void SimulatedVehicle::say(const std::string& text, std::uint8_t severity, const Send& send) const {
  send(MessageId::kStatusText, PayloadWriter(54).put(0, severity).put_text(1, text, 50), 0);
}

void SimulatedVehicle::take(const Frame& frame, const Send& send) {
  if (missions_.take(frame, now_ns_, send)) return;
  const PayloadReader payload(frame.payload);
  const auto for_us = [&](std::size_t at) {
    const auto target = payload.at<std::uint8_t>(at);
    return target == 0 || target == setup_.system;
  };
  switch (static_cast<MessageId>(frame.message_id)) {
    case MessageId::kCommandLong:
    case MessageId::kCommandInt:
      if (for_us(30)) take_command(frame, send);
      return;
    case MessageId::kSetMode:
      if (for_us(4)) (void)change_mode(static_cast<Mode>(payload.at<std::uint32_t>(0)), send);
      return;
    case MessageId::kParamRequestList:
      if (for_us(0)) take_parameter_message(frame, send);
      return;
    case MessageId::kParamRequestRead:
      if (for_us(2)) take_parameter_message(frame, send);
      return;
    case MessageId::kParamSet:
      if (for_us(4)) take_parameter_message(frame, send);
      return;
    case MessageId::kMissionSetCurrent: {
      const auto number = payload.at<std::uint16_t>(0);
      const auto item = std::find_if(flown_.items.begin(),
                                     flown_.items.end(),
                                     [&](const auto& each) { return each.number == number; });
      if (!for_us(2) || item == flown_.items.end() || !aircraft_ || mode_ != Mode::kAuto) return;
      follow(flown_, static_cast<std::size_t>(item - flown_.items.begin()));
      return;
    }
    case MessageId::kRequestDataStream: {
      const auto rate_hz = payload.at<std::uint16_t>(0);
      if (!for_us(2)) return;
      const bool on = payload.at<std::uint8_t>(5) != 0 && rate_hz > 0;
      for (auto& [id, due] : due_) {
        if (id == MessageId::kHeartbeat) continue;
        due.interval_ns = on ? std::max(kShortestIntervalNs, interval_of(rate_hz)) : 0;
      }
      return;
    }
    case MessageId::kTimesync:
      // A request has no time of its own.
      if (payload.at<std::int64_t>(0) != 0 || !for_us(16)) return;
      send(MessageId::kTimesync,
           PayloadWriter(18)
               .put(0, now_ns_)
               .put(8, payload.at<std::int64_t>(8))
               .put(16, frame.system)
               .put(17, frame.component),
           frame.system);
      return;
    default:
      return;
  }
}

void SimulatedVehicle::take_command(const Frame& frame, const Send& send) {
  const auto command = PayloadReader(frame.payload).at<std::uint16_t>(28);
  const std::uint8_t result = run(command, frame, frame.system, send);
  send(
      MessageId::kCommandAck,
      PayloadWriter(10).put(0, command).put(2, result).put(8, frame.system).put(9, frame.component),
      frame.system);
}

std::uint8_t SimulatedVehicle::run(std::uint16_t command,
                                   const Frame& frame,
                                   std::uint8_t system,
                                   const Send& send) {
  const PayloadReader payload(frame.payload);
  const auto parameter = [&](std::size_t number) {
    return static_cast<double>(payload.at<float>(4 * (number - 1)));
  };
  constexpr double kForce = 21196.0;
  switch (command) {
    case kArmDisarm:
      return arm(parameter(1) == 1.0, parameter(2) == kForce, send);
    case kDoSetMode:
      return change_mode(
          static_cast<Mode>(static_cast<std::uint32_t>(std::clamp(parameter(2), 0.0, 1e6))), send);
    case kMissionStart:
      if (!armed_) return kResultDenied;
      return change_mode(Mode::kAuto, send);
    case kNavReturn:
      return change_mode(Mode::kReturn, send);
    case kNavLoiterUnlimited:
      return change_mode(Mode::kLoiter, send);
    case kDoReposition:
      return reposition(frame, send);
    case kSetMessageInterval:
      return set_interval(frame);
    case kGetHomePosition:
    case kRequestCapabilities:
    case kRequestMessage: {
      const MessageId id = command == kGetHomePosition ? MessageId::kHomePosition
                           : command == kRequestCapabilities
                               ? MessageId::kAutopilotVersion
                               : static_cast<MessageId>(static_cast<std::uint32_t>(
                                     std::clamp(parameter(1), 0.0, 1e7)));
      const auto wanted = payload_of(id, report());
      if (!wanted) return kResultUnsupported;
      send(id, *wanted, system);
      return kResultAccepted;
    }
    default:
      return kResultUnsupported;
  }
}

std::uint8_t SimulatedVehicle::set_interval(const Frame& frame) {
  const PayloadReader payload(frame.payload);
  const double number = payload.at<float>(0);
  const double interval_us = payload.at<float>(4);
  if (!(number >= 0.0 && number < 1e7) || !std::isfinite(interval_us)) return kResultDenied;
  const auto id = static_cast<MessageId>(static_cast<std::uint32_t>(number));
  const auto known = due_.find(id);
  if (known == due_.end()) return kResultUnsupported;
  if (interval_us < 0.0) {
    known->second.interval_ns = 0;
  } else if (interval_us == 0.0) {
    for (const auto& [each, rate_hz] : kDefaultRates) {
      if (each == id) known->second.interval_ns = rate_hz > 0.0 ? interval_of(rate_hz) : 0;
    }
  } else {
    known->second.interval_ns =
        std::max(kShortestIntervalNs, static_cast<std::int64_t>(1e3 * std::min(interval_us, 1e9)));
  }
  known->second.next_ns = now_ns_;
  return kResultAccepted;
}

std::uint8_t SimulatedVehicle::arm(bool wanted, bool forced, const Send& send) {
  if (!wanted) {
    if (aircraft_ && !forced) {
      say("Disarm: in flight", kWarning, send);
      return kResultFailed;
    }
    armed_ = false;
    aircraft_.reset();
    autopilot_.reset();
    if (!aircraft_) parked_m_.z() = 0.0;
    return kResultAccepted;
  }
  armed_ = true;
  return kResultAccepted;
}

std::uint8_t SimulatedVehicle::change_mode(Mode mode, const Send& send) {
  switch (mode) {
    case Mode::kAuto:
      if (!armed_) {
        // As on the ground with ArduPlane: the mission starts with the motor.
        mode_ = mode;
        return kResultAccepted;
      }
      if (Status status = fly_mission(aircraft_ ? resume_item_ : 0); !status) {
        say(status.error().message, kWarning, send);
        return kResultFailed;
      }
      mode_ = mode;
      return kResultAccepted;
    case Mode::kReturn:
    case Mode::kLoiter:
    case Mode::kGuided: {
      if (aircraft_) {
        if (mode_ == Mode::kAuto) resume_item_ = autopilot_->pilot().item();
        const Eigen::Vector3d at = aircraft_->state().position_world_m;
        mode_ = mode;
        circle(mode == Mode::kReturn ? Eigen::Vector3d(0.0, 0.0, parameters_.rtl_altitude) : at);
      } else {
        mode_ = mode;
      }
      return kResultAccepted;
    }
    case Mode::kManual:
      if (aircraft_) {
        say("MANUAL: there is no pilot", kWarning, send);
        return kResultFailed;
      }
      mode_ = mode;
      return kResultAccepted;
  }
  say("Mode " + std::to_string(static_cast<std::uint32_t>(mode)) + " is not supported",
      kWarning,
      send);
  return kResultUnsupported;
}

std::uint8_t SimulatedVehicle::reposition(const Frame& frame, const Send& send) {
  const PayloadReader payload(frame.payload);
  // Only COMMAND_INT has positions of full resolution.
  if (static_cast<MessageId>(frame.message_id) != MessageId::kCommandInt) return kResultUnsupported;
  const double lat_deg = 1e-7 * payload.at<std::int32_t>(16);
  const double lon_deg = 1e-7 * payload.at<std::int32_t>(20);
  const double height = payload.at<float>(24);
  const auto kind = payload.at<std::uint8_t>(32);
  const bool above_home = kind == 3 || kind == 6;
  if (!aircraft_ || !(std::abs(lat_deg) <= 90.0) || !(std::abs(lon_deg) <= 180.0) ||
      !std::isfinite(height) || !(above_home || kind == 0 || kind == 5)) {
    return kResultDenied;
  }
  Eigen::Vector3d place =
      frame_.world_from_geodetic(geodetic_from_deg(lat_deg, lon_deg, setup_.home.alt_ellipsoid_m));
  place.z() = above_home ? height : height - setup_.home.alt_ellipsoid_m;
  constexpr double kFarM = 1e5;
  if (!(place.head<2>().norm() < kFarM && place.z() > 10.0 && place.z() < 1e4))
    return kResultDenied;
  if (change_mode(Mode::kGuided, send) != kResultAccepted) return kResultFailed;
  circle(place);
  return kResultAccepted;
}

void SimulatedVehicle::send_parameter(std::size_t index,
                                      std::uint8_t system,
                                      const Send& send) const {
  const auto table = autopilot::parameter_table();
  send(MessageId::kParamValue,
       PayloadWriter(25)
           .put(0, static_cast<float>(parameters_.*table[index].value))
           .put(4, static_cast<std::uint16_t>(table.size()))
           .put(6, static_cast<std::uint16_t>(index))
           .put_text(8, table[index].name, 16)
           .put(24, kReal32),
       system);
}

void SimulatedVehicle::take_parameter_message(const Frame& frame, const Send& send) {
  const PayloadReader payload(frame.payload);
  const auto table = autopilot::parameter_table();
  const auto index_of = [&](const std::string& name) {
    return static_cast<std::size_t>(
        std::find_if(
            table.begin(), table.end(), [&](const auto& each) { return name == each.name; }) -
        table.begin());
  };
  switch (static_cast<MessageId>(frame.message_id)) {
    case MessageId::kParamRequestList:
      for (std::size_t i = 0; i < table.size(); ++i) send_parameter(i, frame.system, send);
      return;
    case MessageId::kParamRequestRead: {
      const auto asked = payload.at<std::int16_t>(0);
      const std::size_t index =
          asked >= 0 ? static_cast<std::size_t>(asked) : index_of(payload.text(4, 16));
      if (index < table.size()) send_parameter(index, frame.system, send);
      return;
    }
    default: {
      const std::string name = payload.text(6, 16);
      const std::size_t index = index_of(name);
      if (index >= table.size()) return;
      autopilot::Parameters changed = parameters_;
      Status status = autopilot::set_parameter(changed, name, payload.at<float>(0));
      if (status) status = autopilot::check(changed);
      if (status) {
        parameters_ = changed;
        // The loops take the new values over where they are.
        if (aircraft_) follow(flown_, autopilot_->pilot().item());
      } else {
        say(status.error().message, kWarning, send);
      }
      return send_parameter(index, frame.system, send);
    }
  }
}

void SimulatedVehicle::follow(autopilot::Mission mission, std::size_t item) {
  flown_ = std::move(mission);
  autopilot_.emplace(
      parameters_, setup_.airframe, flown_, [](const Eigen::Vector2d&) { return 0.0; });
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
  Result<autopilot::PlannedMission> planned =
      autopilot::plan_mission(missions_.items(), frame_, ground_, std::nullopt);
  if (!planned) return planned.error();
  if (aircraft_) {
    follow(std::move(planned->mission), std::min(item, planned->mission.items.size() - 1));
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
                        parameters_,
                        parked_m_,
                        parked_heading_rad_);
  if (!aircraft) return aircraft.error();
  aircraft_ = std::move(*aircraft);
  ++flights_;
  resume_item_ = 0;
  follow(std::move(planned->mission), 0);
  return {};
}

/// Contact with the ground, or the end of the mission.
void SimulatedVehicle::finish_flight(const Send& send) {
  const autopilot::FlightPhase phase = autopilot_->pilot().phase();
  if (aircraft_->state().position_world_m.z() <= 0.0) {
    const bool landed = phase == autopilot::FlightPhase::kFlare;
    const autopilot::FlightState state = autopilot::flight_state(*aircraft_);
    parked_m_ = {state.position_world_m.x(), state.position_world_m.y(), 0.0};
    parked_heading_rad_ = state.attitude.yaw_rad;
    aircraft_.reset();
    autopilot_.reset();
    resume_item_ = 0;
    armed_ = false;
    mode_ = Mode::kManual;
    say(landed ? "Landed" : "Crashed: hit the ground", landed ? kInfo : kCritical, send);
    return;
  }
  if (phase == autopilot::FlightPhase::kDone && mode_ == Mode::kAuto) {
    say("Mission complete, changing mode to RTL", kInfo, send);
    (void)change_mode(Mode::kReturn, send);
  }
}

void SimulatedVehicle::step(const Send& send) {
  now_ns_ += kStepNs;
  if (armed_ && !aircraft_ && mode_ == Mode::kAuto) {
    if (Status status = fly_mission(0); !status) {
      say(status.error().message, kWarning, send);
      mode_ = Mode::kManual;
    }
  }
  if (aircraft_) {
    const std::size_t before = autopilot_->pilot().item();
    const dynamics::Controls commands = autopilot_->update(autopilot::flight_state(*aircraft_));
    constexpr int kParts = 4;
    for (int i = 0; i < kParts; ++i) aircraft_->step(commands, 1e-9 * kStepNs / kParts);
    const std::size_t after = autopilot_->pilot().item();
    if (after != before && mode_ == Mode::kAuto && before < flown_.items.size()) {
      send(MessageId::kMissionItemReached, PayloadWriter(2).put(0, flown_.items[before].number), 0);
    }
    finish_flight(send);
  }
  missions_.step(now_ns_, send);
  const VehicleReport now = report();
  for (auto& [id, due] : due_) {
    if (due.interval_ns == 0 || now_ns_ < due.next_ns) continue;
    // Late by less than a step: the rate holds over time.
    due.next_ns = std::max(due.next_ns + due.interval_ns, now_ns_ + due.interval_ns / 2);
    if (const auto payload = payload_of(id, now)) send(id, *payload, 0);
  }
}

}  // namespace overfly::vehicle
