#include "server/scenario/document/flight/scenario_live.hpp"

#include <chrono>
#include <cmath>
#include <string>

#include "core/motion/pose.hpp"
#include "core/time.hpp"
#include "flight/mavlink/vehicle/parameters.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;
using flight::live::LiveFlight;
using flight::live::TruthPreference;

TruthPreference preference_from(const std::string& name) {
  if (name == "simulation") return TruthPreference::kSimulation;
  if (name == "estimate") return TruthPreference::kEstimate;
  return TruthPreference::kBest;
}

flight::mavlink::FeedbackMessage message_from(const std::string& name) {
  using flight::mavlink::FeedbackMessage;
  if (name == "vision_position_estimate") return FeedbackMessage::kVisionPositionEstimate;
  if (name == "gps_input") return FeedbackMessage::kGpsInput;
  return FeedbackMessage::kOdometry;
}

Result<flight::mavlink::FeedbackOptions> read_feedback(const Json& document) {
  const auto optional = [&](const char* field, double unit) {
    return document.contains(field) ? std::optional(unit * document.at(field).get<double>())
                                    : std::nullopt;
  };
  flight::mavlink::FeedbackOptions feedback;
  feedback.message = message_from(document.at("message").get<std::string>());
  feedback.latency_ns = std::llround(1e6 * document.at("latency_ms").get<double>());
  feedback.rate_hz = document.at("rate_hz").get<double>();
  feedback.send_height = document.at("send_height").get<bool>();
  feedback.set_origin = document.at("set_origin").get<bool>();
  feedback.position_std_dev_m = optional("position_std_dev_m", 1.0);
  feedback.attitude_std_dev_rad = optional("attitude_std_dev_deg", kPi / 180.0);
  feedback.velocity_std_dev_m_s = optional("velocity_std_dev_m_s", 1.0);
  const bool half =
      feedback.position_std_dev_m.has_value() != feedback.attitude_std_dev_rad.has_value();
  if (half && feedback.message != flight::mavlink::FeedbackMessage::kGpsInput) {
    return Error{ErrorCode::kInvalidArgument,
                 "flight.mavlink.feedback: position_std_dev_m and attitude_std_dev_deg must be "
                 "given together: a message has one covariance of both"};
  }
  return feedback;
}

/// A read-only link cannot ask for anything.
Status check_read_only(const LiveFlight& flight) {
  const char* field = nullptr;
  if (!flight.parameters.empty()) field = "parameters";
  if (flight.mission_file) field = "mission_file";
  if (flight.arm_and_start) field = "arm_and_start";
  if (flight.feedback) field = "feedback";
  if (flight.sensor_rate_hz > 0.0) field = "sensor_rate_hz";
  if (!flight.read_only || field == nullptr) return {};
  return Error{ErrorCode::kInvalidArgument,
               std::string("flight.mavlink.") + field +
                   ": must not be given with read_only = true, which sends nothing"};
}

}  // namespace

Result<LiveFlight> read_live_flight(Json& mavlink, const FileResolver& files) {
  LiveFlight flight;
  const Result<flight::mavlink::LinkAddress> link = flight::mavlink::parse_link_address(
      mavlink.at("link").get<std::string>(), "flight.mavlink.link");
  if (!link) return link.error();
  flight.link = *link;
  flight.read_only = mavlink.at("read_only").get<bool>();
  flight.system = mavlink.at("system").get<std::uint8_t>();
  if (mavlink.contains("signing_key_file")) {
    flight.signing_key_file = files.resolve(mavlink.at("signing_key_file"));
  }
  flight.rate_hz = mavlink.at("rate_hz").get<double>();
  flight.sensor_rate_hz = mavlink.at("sensor_rate_hz").get<double>();
  for (const auto& [name, value] : mavlink.at("parameters").items()) {
    if (!flight::mavlink::is_parameter_name(name)) {
      return Error{ErrorCode::kInvalidArgument,
                   "flight.mavlink.parameters: a name must be 1 to 16 letters, digits or "
                   "underscores"};
    }
    flight.parameters[name] = value.get<double>();
  }
  if (mavlink.contains("mission_file")) {
    flight.mission_file = files.resolve(mavlink.at("mission_file"));
  }
  flight.arm_and_start = mavlink.at("arm_and_start").get<bool>();
  flight.truth.truth = preference_from(mavlink.at("truth").get<std::string>());
  flight.truth.geoid_separation_m = mavlink.at("geoid_separation_m").get<double>();
  flight.truth.gap_limit_ns = ns_from_s(mavlink.at("gap_limit_s").get<double>());
  flight.truth.patience =
      std::chrono::milliseconds(std::llround(1e3 * mavlink.at("patience_s").get<double>()));
  const Json& start = mavlink.at("start");
  if (start.contains("mission_item")) {
    flight.truth.start.mission_item = start.at("mission_item").get<std::int32_t>();
  }
  const Json& stop = mavlink.at("stop");
  flight.truth.stop.on_disarm = stop.at("on_disarm").get<bool>();
  flight.truth.stop.on_landing = stop.at("on_landing").get<bool>();
  if (stop.contains("mission_item")) {
    flight.truth.stop.mission_item = stop.at("mission_item").get<std::int32_t>();
  }
  if (mavlink.contains("feedback")) {
    const auto feedback = read_feedback(mavlink.at("feedback"));
    if (!feedback) return feedback.error();
    flight.feedback = *feedback;
  }
  if (Status status = check_read_only(flight); !status) return status.error();
  return flight;
}

Status find_feedback_estimator(const Json& document, Scenario& scenario) {
  const auto* live = std::get_if<LiveFlight>(&scenario.flight);
  if (live == nullptr || !live->feedback) return {};
  const auto name =
      document.at("flight").at("mavlink").at("feedback").at("estimator").get<std::string>();
  std::string names;
  for (std::size_t i = 0; i < scenario.estimators.size(); ++i) {
    if (scenario.estimators[i].name == name) {
      scenario.feedback_estimator = i;
      return {};
    }
    names += (i == 0 ? "" : ", ") + scenario.estimators[i].name;
  }
  return Error{ErrorCode::kInvalidArgument,
               "flight.mavlink.feedback.estimator = " + name +
                   ": must be the name of one of the scenario's estimators" +
                   (names.empty() ? ": it has none" : ": " + names)};
}

}  // namespace overfly::server
