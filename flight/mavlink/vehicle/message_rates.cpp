#include "flight/mavlink/vehicle/message_rates.hpp"

#include <cmath>
#include <optional>

#include "core/text/number_text.hpp"
#include "flight/mavlink/message_table.hpp"
#include "flight/mavlink/vehicle/commands.hpp"

namespace overfly::flight::mavlink {
namespace {

constexpr std::uint16_t kSetMessageInterval = 511;
constexpr std::uint8_t kIntervalAccepted = 0;
constexpr std::uint8_t kIntervalDenied = 2;
/// ArduPilot denies rates above 0.8 times that of its main loop: the next lower rate is tried.
constexpr double kLowerRate = 0.8;
constexpr int kRatesTried = 10;

/// MAV_DATA_STREAM of a message, as ArduPlane groups its messages.
std::optional<std::uint8_t> stream_with(MessageId message) {
  switch (message) {
    case MessageId::kRawImu:
    case MessageId::kScaledImu:
    case MessageId::kScaledImu2:
    case MessageId::kScaledImu3:
      return 1;  // raw sensors
    case MessageId::kSysStatus:
    case MessageId::kGpsRawInt:
    case MessageId::kMissionCurrent:
      return 2;  // extended status
    case MessageId::kGlobalPositionInt:
    case MessageId::kLocalPositionNed:
      return 6;  // position
    case MessageId::kAttitude:
    case MessageId::kAttitudeQuaternion:
    case MessageId::kSimState:
    case MessageId::kSimstate:
    case MessageId::kAhrs2:
      return 10;  // extra 1
    case MessageId::kVfrHud:
      return 11;  // extra 2
    case MessageId::kSystemTime:
      return 12;  // extra 3
    default:
      return std::nullopt;
  }
}

}  // namespace

Result<RateRequest> request_message_rate(Exchange& exchange, MessageId message, double rate_hz) {
  const auto id = static_cast<std::uint32_t>(message);
  const MessageFacts* const facts = message_facts(id);
  const std::string what =
      "rate of " + (facts != nullptr ? std::string(facts->name) : std::to_string(id));
  if (!(rate_hz > 0.0 && rate_hz <= 1000.0)) {
    return Error{ErrorCode::kInvalidArgument,
                 what + " = " + number_text(rate_hz) + " Hz: must be in (0, 1000]"};
  }
  double asked_hz = rate_hz;
  for (int i = 0; i < kRatesTried; ++i, asked_hz *= kLowerRate) {
    const Command command{
        what,
        kSetMessageInterval,
        {static_cast<float>(id), static_cast<float>(std::round(1e6 / asked_hz)), 0, 0, 0, 0, 0}};
    const Result<std::uint8_t> result =
        command_result(exchange, command, {std::chrono::milliseconds(700), 3});
    // kIo: no answer, as from firmware that does not know the command.
    if (!result && result.error().code != ErrorCode::kIo) return result.error();
    if (result && *result == kIntervalAccepted) return RateRequest::kInterval;
    if (!result || *result != kIntervalDenied) break;
  }
  const std::optional<std::uint8_t> stream = stream_with(message);
  if (!stream) return RateRequest::kNone;
  const auto whole_rate_hz = static_cast<std::uint16_t>(std::ceil(rate_hz));
  const Status sent = exchange.send(MessageId::kRequestDataStream,
                                    PayloadWriter(6)
                                        .put(0, whole_rate_hz)
                                        .put(2, exchange.target().system)
                                        .put(3, exchange.target().component)
                                        .put(4, *stream)
                                        .put(5, std::uint8_t{1}));
  if (!sent) return sent.error().in(what);
  return RateRequest::kStream;
}

}  // namespace overfly::flight::mavlink
