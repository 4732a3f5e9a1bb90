// Rates at which a vehicle sends its messages.
#pragma once

#include <cstdint>
#include <string>

#include "flight/mavlink/vehicle/exchange.hpp"

namespace overfly::flight::mavlink {

/// How a rate was asked for.
enum class RateRequest {
  kInterval,  ///< SET_MESSAGE_INTERVAL, acknowledged
  kStream,    ///< REQUEST_DATA_STREAM of old firmware, which nothing confirms
  kNone,      ///< the vehicle knows the message by neither
};

/// Asks a vehicle to send a message at a rate. SET_MESSAGE_INTERVAL is tried first, with lower
/// rates, down to a tenth, while the vehicle denies them. If it does not know the command or does
/// not answer, the stream that contains the message in ArduPilot is asked for. A vehicle may send
/// at a lower rate than the one it accepts: what arrives has to be counted.
/// @param rate_hz  in (0, 1000]
/// Errors: kInvalidArgument naming the rate; as ask() except for answers that do not come.
[[nodiscard]] Result<RateRequest> request_message_rate(Exchange& exchange,
                                                       MessageId message,
                                                       double rate_hz);

}  // namespace overfly::flight::mavlink
