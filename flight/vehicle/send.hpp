// How a simulated vehicle sends messages.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "flight/mavlink/messages.hpp"
#include "flight/mavlink/payload.hpp"

namespace overfly::vehicle {

/// Sends a message to a system; 0: to all.
using Send = std::function<void(flight::mavlink::MessageId id,
                                const flight::mavlink::PayloadWriter& payload,
                                std::uint8_t system)>;

/// MAV_SEVERITY.
enum class Severity : std::uint8_t { kCritical = 2, kWarning = 4, kInfo = 6 };

/// Sends a text to all, in parts of 50 bytes that belong together by `number` (STATUSTEXT's id).
/// @param number  > 0, another one for each text
void send_text(const std::string& text, Severity severity, std::uint16_t number, const Send& send);

}  // namespace overfly::vehicle
