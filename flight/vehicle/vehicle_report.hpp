// What a simulated vehicle tells about itself, as MAVLink messages.
#pragma once

#include <optional>

#include "flight/mavlink/messages.hpp"
#include "flight/mavlink/payload.hpp"
#include "flight/vehicle/reported_state.hpp"

namespace overfly::vehicle {

/// The payload of a message that describes the vehicle, or of one of its sensors, which measure
/// without errors; empty for one that it does not send.
[[nodiscard]] std::optional<flight::mavlink::PayloadWriter> payload_of(
    flight::mavlink::MessageId id, const VehicleReport& report);

}  // namespace overfly::vehicle
