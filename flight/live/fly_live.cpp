#include "flight/live/fly_live.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "flight/live/live_truth.hpp"
#include "flight/mavlink/feedback/feedback_sender.hpp"
#include "flight/mavlink/feedback/prepare_feedback.hpp"
#include "flight/mavlink/link/signing.hpp"
#include "flight/mavlink/vehicle/commands.hpp"
#include "flight/mavlink/vehicle/message_rates.hpp"
#include "flight/mavlink/vehicle/mission.hpp"
#include "flight/mavlink/vehicle/parameters.hpp"
#include "flight/mavlink/vehicle/vehicle.hpp"

namespace overfly::flight::live {
namespace {

using mavlink::MessageId;

constexpr std::chrono::seconds kArmingLimit{60};
/// Of messages that are read for the begin and the end of the flight, and of speeds.
constexpr double kSlowRateHz = 5.0;
/// A mission's height that differs by more is another one.
constexpr double kHeightRoundingM = 0.02;

Status request_rates(mavlink::Exchange& exchange, const LiveFlight& flight) {
  if (flight.rate_hz <= 0.0) return {};
  std::vector<std::pair<MessageId, double>> rates = {{MessageId::kAttitude, flight.rate_hz},
                                                     {MessageId::kVfrHud, kSlowRateHz},
                                                     {MessageId::kMissionCurrent, kSlowRateHz}};
  if (flight.truth.truth != TruthPreference::kEstimate) {
    rates.emplace_back(MessageId::kSimState, flight.rate_hz);
  }
  // The vehicle's own height goes with estimates without one.
  const bool own_height = flight.feedback && !flight.feedback->send_height;
  if (flight.truth.truth != TruthPreference::kSimulation || own_height) {
    rates.emplace_back(MessageId::kGlobalPositionInt, flight.rate_hz);
  }
  if (flight.feedback && flight.feedback->message == mavlink::FeedbackMessage::kGpsInput) {
    rates.emplace_back(MessageId::kSystemTime, 1.0);
  }
  if (flight.truth.stop.on_landing) {
    rates.emplace_back(MessageId::kExtendedSysState, kSlowRateHz);
  }
  for (const auto& [message, rate_hz] : rates) {
    // A message that the vehicle does not have is missed later, if it is needed.
    const auto requested = mavlink::request_message_rate(exchange, message, rate_hz);
    if (!requested) return requested.error();
  }
  return {};
}

/// Asks for the messages of the vehicle's sensors: of each sensor for the best one that it has.
Status request_sensor_rates(mavlink::Exchange& exchange, const LiveFlight& flight) {
  if (flight.sensor_rate_hz <= 0.0) return {};
  constexpr std::uint8_t kArduPilot = 3;
  const bool is_ardupilot = exchange.target().autopilot == kArduPilot;
  struct Sensor {
    std::vector<MessageId> messages;  ///< the first is the best
    double most_hz;
  };
  const Sensor sensors[] = {
      {{MessageId::kHighresImu, is_ardupilot ? MessageId::kRawImu : MessageId::kScaledImu}, 1000.0},
      {{MessageId::kScaledPressure}, 20.0},
      {{MessageId::kAirspeed, MessageId::kVfrHud}, 20.0},
      {{MessageId::kGpsRawInt}, 10.0},
      {{MessageId::kDistanceSensor, MessageId::kRangefinder}, 20.0},
  };
  bool has_high_resolution = false;
  for (const Sensor& sensor : sensors) {
    for (const MessageId message : sensor.messages) {
      const double rate_hz = std::min(flight.sensor_rate_hz, sensor.most_hz);
      const auto requested = mavlink::request_message_rate(exchange, message, rate_hz);
      if (!requested) return requested.error();
      if (*requested != mavlink::RateRequest::kInterval) continue;
      has_high_resolution = has_high_resolution || message == MessageId::kHighresImu;
      break;
    }
  }
  if (!is_ardupilot || !has_high_resolution) return {};
  // The magnetic field of its HIGHRES_IMU is not in gauss.
  const auto requested = mavlink::request_message_rate(
      exchange, MessageId::kRawImu, std::min(flight.sensor_rate_hz, 20.0));
  if (!requested) return requested.error();
  return {};
}

/// Whether the vehicle's mission is the one that was sent. Item 0 is the home position, which
/// ArduPilot keeps for itself; it rounds positions to 1e-7 deg and heights to 0.01 m.
bool is_same_mission(const std::vector<mavlink::MissionItem>& sent,
                     const std::vector<mavlink::MissionItem>& stored) {
  if (sent.size() != stored.size()) return false;
  for (std::size_t i = 1; i < sent.size(); ++i) {
    if (sent[i].command != stored[i].command || std::abs(sent[i].x - stored[i].x) > 1e-6 ||
        std::abs(sent[i].y - stored[i].y) > 1e-6) {
      return false;
    }
    // Vehicles need not keep the height of an item without a place.
    const bool has_place = sent[i].x != 0.0 || sent[i].y != 0.0;
    if (has_place && std::abs(sent[i].z - stored[i].z) > kHeightRoundingM) return false;
  }
  return true;
}

/// @param warnings  of the mission's file are added to these
Status set_mission(mavlink::Exchange& exchange,
                   const std::filesystem::path& file,
                   std::vector<std::string>& warnings) {
  const auto mission = mavlink::read_mission_file(file);
  if (!mission) return mission.error();
  warnings.insert(warnings.end(), mission->warnings.begin(), mission->warnings.end());
  if (Status status = mavlink::upload_mission(exchange, mission->items); !status) return status;
  const auto stored = mavlink::download_mission(exchange);
  if (!stored) return stored.error();
  if (is_same_mission(mission->items, *stored)) return {};
  return Error{ErrorCode::kConflict,
               file.string() + ": " + exchange.target().name() +
                   " has not stored the mission as it was sent"};
}

Status prepare(mavlink::Exchange& exchange,
               const LiveFlight& flight,
               const LocalFrame& frame,
               std::vector<std::string>& warnings) {
  if (Status status = request_rates(exchange, flight); !status) return status;
  if (Status status = request_sensor_rates(exchange, flight); !status) return status;
  for (const auto& [name, value] : flight.parameters) {
    if (Status status = mavlink::set_parameter(exchange, name, value); !status) return status;
  }
  if (flight.mission_file) {
    if (Status status = set_mission(exchange, *flight.mission_file, warnings); !status)
      return status;
  }
  if (flight.feedback) {
    const Geodetic& origin = frame.origin();
    const mavlink::GlobalPosition msl{deg_from_rad(origin.lat_rad),
                                      deg_from_rad(origin.lon_rad),
                                      origin.alt_ellipsoid_m - flight.truth.geoid_separation_m};
    Status status = mavlink::prepare_feedback(exchange, *flight.feedback, msl);
    if (!status) return status;
  }
  if (!flight.arm_and_start) return {};
  if (Status status = mavlink::arm(exchange, kArmingLimit); !status) return status;
  return mavlink::start_mission(exchange);
}

}  // namespace

Result<std::unique_ptr<TruthSource>> fly_live(const LiveFlight& flight,
                                              const LocalFrame& frame,
                                              const std::atomic<bool>* cancel,
                                              const LiveRecording& recording) {
  mavlink::VehicleOptions options;
  LiveTruthOptions truth_options = flight.truth;
  if (!recording.tlog.empty()) {
    auto recorder = mavlink::FrameRecorder::create(recording.tlog);
    if (!recorder) return recorder.error();
    options.link.recorder = *recorder;
    truth_options.recorder = std::move(*recorder);
  }
  options.system = flight.system;
  options.link.read_only = flight.read_only;
  if (flight.signing_key_file) {
    const auto key = mavlink::read_signing_key(*flight.signing_key_file);
    if (!key) return key.error();
    options.link.key = *key;
    options.link.sign = true;
  }
  Result<std::unique_ptr<mavlink::Vehicle>> opened = mavlink::Vehicle::open(flight.link, options);
  if (!opened) return opened.error();
  const std::shared_ptr<mavlink::Vehicle> vehicle = std::move(*opened);
  if (Status heard = vehicle->wait_until_heard(flight.truth.patience, cancel); !heard) {
    return heard.error();
  }
  if (!flight.read_only) {
    const std::unique_ptr<mavlink::Exchange> exchange = vehicle->converse(cancel);
    if (Status status = prepare(*exchange, flight, frame, truth_options.warnings); !status) {
      return status.error().in(flight.link.text());
    }
  }
  Result<std::unique_ptr<LiveTruth>> truth = LiveTruth::open(vehicle, frame, truth_options, cancel);
  if (!truth) return truth.error();
  if (flight.feedback) {
    (*truth)->send_estimates_by(std::make_shared<mavlink::FeedbackSender>(
        vehicle, *flight.feedback, frame, flight.truth.geoid_separation_m, (*truth)->start_ns()));
  }
  return std::unique_ptr<TruthSource>(std::move(*truth));
}

}  // namespace overfly::flight::live
