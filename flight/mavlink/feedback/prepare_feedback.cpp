#include "flight/mavlink/feedback/prepare_feedback.hpp"

#include <chrono>
#include <cmath>
#include <string>

#include "flight/mavlink/autopilots.hpp"
#include "flight/mavlink/vehicle/commands.hpp"
#include "flight/mavlink/vehicle/parameters.hpp"

namespace overfly::flight::mavlink {
namespace {

constexpr std::uint16_t kRequestMessageCommand = 512;
constexpr const char* kHeightSource = "EK3_SRC1_POSZ";
constexpr double kSourceGps = 3.0;
constexpr double kSourceExternal = 6.0;

bool is_origin(const Exchange& exchange, const HeldMessage& message) {
  return message.is(MessageId::kGpsGlobalOrigin) && is_from_target(exchange, message) &&
         message.reader().at<std::int32_t>(0) != 0;
}

/// An autopilot that has just started waits for its position first.
constexpr int kPatientAttempts = 60;
constexpr int kAttempts = 3;

/// Whether the vehicle has an origin. @param attempts  of one second each
Result<bool> has_origin(Exchange& exchange, int attempts) {
  Command request{"asking for the origin", kRequestMessageCommand, {}};
  request.parameters[0] = static_cast<float>(MessageId::kGpsGlobalOrigin);
  bool found = false;
  // The message may come before its acknowledgement, which command_result would drop.
  for (int attempt = 0; attempt < attempts && !found; ++attempt) {
    PayloadWriter payload(33);
    payload.put(0, request.parameters[0]).put(28, request.id);
    payload.put(30, exchange.target().system).put(31, exchange.target().component);
    payload.put(32, static_cast<std::uint8_t>(attempt));
    if (Status sent = exchange.send(MessageId::kCommandLong, payload); !sent) return sent.error();
    const auto answer =
        wait_for(exchange, exchange.now() + std::chrono::seconds(1), [&](const HeldMessage& each) {
          return is_origin(exchange, each);
        });
    if (!answer) return answer.error();
    found = answer->has_value();
  }
  return found;
}

Status set_origin(Exchange& exchange, const GlobalPosition& origin) {
  const auto request = [&](int /*attempt*/) {
    return exchange.send(
        MessageId::kSetGpsGlobalOrigin,
        PayloadWriter(21)
            .put(0, static_cast<std::int32_t>(std::llround(1e7 * origin.lat_deg)))
            .put(4, static_cast<std::int32_t>(std::llround(1e7 * origin.lon_deg)))
            .put(8, static_cast<std::int32_t>(std::llround(1e3 * origin.alt_msl_m)))
            .put(12, exchange.target().system));
  };
  const auto answer =
      ask(exchange, "setting the origin", {}, request, [&](const HeldMessage& each) {
        return is_origin(exchange, each);
      });
  return answer ? Status() : answer.error();
}

Status check_origin(Exchange& exchange,
                    const FeedbackOptions& options,
                    const GlobalPosition& origin) {
  const Result<bool> found =
      has_origin(exchange, options.set_origin ? kAttempts : kPatientAttempts);
  if (!found) return found.error();
  if (*found) return {};
  if (options.set_origin) return set_origin(exchange, origin);
  return Error{ErrorCode::kConflict,
               "feedback: " + exchange.target().name() +
                   " has had no origin of local positions (GPS_GLOBAL_ORIGIN) for " +
                   std::to_string(kPatientAttempts) +
                   " s: it needs a position, or give set_origin = true"};
}

Status check_height_source(Exchange& exchange, const FeedbackOptions& options) {
  const Result<Parameter> source = read_parameter(exchange, kHeightSource);
  if (!source) {
    return source.error().code == ErrorCode::kNotFound ? Status() : Status(source.error());
  }
  const bool gps = options.message == FeedbackMessage::kGpsInput;
  if (source->value != (gps ? kSourceGps : kSourceExternal)) return {};
  return Error{ErrorCode::kConflict,
               "feedback.send_height = false: " + exchange.target().name() + " has " +
                   kHeightSource + " = " + std::to_string(std::lround(source->value)) +
                   ", so its height would follow the height in " + to_string(options.message) +
                   ", which is not measured: set it to 1 (barometer) in flight.mavlink.parameters, "
                   "or give send_height = true"};
}

}  // namespace

Status prepare_feedback(Exchange& exchange,
                        const FeedbackOptions& options,
                        const GlobalPosition& origin) {
  if (options.message != FeedbackMessage::kGpsInput) {
    if (Status status = check_origin(exchange, options, origin); !status) return status;
  }
  if (options.send_height || exchange.target().autopilot != kArduPilot) return {};
  return check_height_source(exchange, options);
}

}  // namespace overfly::flight::mavlink
