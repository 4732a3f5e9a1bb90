// What ground stations send to the simulated vehicle.
#include <cmath>
#include <utility>

#include "flight/autopilot/mission_flight.hpp"
#include "flight/vehicle/simulated_vehicle.hpp"

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

/// A whole number that a client sends as a float; 0 for anything else.
std::uint32_t number_from_float(double value) {
  return value >= 0.0 && value < 1e7 ? static_cast<std::uint32_t>(value) : 0U;
}

}  // namespace

void SimulatedVehicle::take(const Frame& frame, const Send& send) {
  if (const std::optional<Status> mission = missions_.take(frame, now_ns_, send)) {
    if (!*mission) say(mission->error().message, Severity::kWarning, send);
    return;
  }
  std::string refusal;
  switch (parameters_.take(frame, send, refusal)) {
    case ParameterStore::Outcome::kNotMine:
      break;
    case ParameterStore::Outcome::kAnswered:
      return;
    case ParameterStore::Outcome::kChanged:
      // The loops take the new values over where they are.
      if (aircraft_) autopilot_->set_parameters(parameters_.values(), setup_.airframe);
      return;
    case ParameterStore::Outcome::kRefused:
      return say(refusal, Severity::kWarning, send);
  }
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
      const bool on = payload.at<std::uint8_t>(5) != 0;
      if (for_us(2)) {
        schedule_.set_stream(
            payload.at<std::uint8_t>(4), on ? payload.at<std::uint16_t>(0) : 0, now_ns_);
      }
      return;
    }
    case MessageId::kVisionPositionEstimate:
    case MessageId::kOdometry:
    case MessageId::kGpsInput:
      ++received_estimates_;
      return;
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
      return change_mode(static_cast<Mode>(number_from_float(parameter(2))), send);
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
      return schedule_.set_interval(parameter(1), parameter(2), now_ns_) ? kResultAccepted
                                                                         : kResultUnsupported;
    case kGetHomePosition:
    case kRequestCapabilities:
    case kRequestMessage: {
      const MessageId id = command == kGetHomePosition ? MessageId::kHomePosition
                           : command == kRequestCapabilities
                               ? MessageId::kAutopilotVersion
                               : static_cast<MessageId>(number_from_float(parameter(1)));
      const auto wanted = payload_of(id, report());
      if (!wanted) return kResultUnsupported;
      send(id, *wanted, system);
      return kResultAccepted;
    }
    default:
      return kResultUnsupported;
  }
}

std::uint8_t SimulatedVehicle::arm(bool wanted, bool forced, const Send& send) {
  if (wanted || !aircraft_) {
    armed_ = wanted;
    return kResultAccepted;
  }
  if (!forced) {
    say("Disarm: in flight", Severity::kWarning, send);
    return kResultFailed;
  }
  park("Disarmed in flight: crashed below", Severity::kCritical, send);
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
      // A repeated command does not begin the mission again.
      if (mode_ == Mode::kAuto && aircraft_) return kResultAccepted;
      if (Status status = fly_mission(aircraft_ ? resume_item_ : 0); !status) {
        say(status.error().message, Severity::kWarning, send);
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
        circle(mode == Mode::kReturn ? Eigen::Vector3d(0.0, 0.0, parameters_.values().rtl_altitude)
                                     : at);
      } else {
        mode_ = mode;
      }
      return kResultAccepted;
    }
    case Mode::kManual:
      if (aircraft_) {
        say("MANUAL: there is no pilot", Severity::kWarning, send);
        return kResultFailed;
      }
      mode_ = mode;
      return kResultAccepted;
  }
  say("Mode " + std::to_string(static_cast<std::uint32_t>(mode)) + " is not supported",
      Severity::kWarning,
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

}  // namespace overfly::vehicle
