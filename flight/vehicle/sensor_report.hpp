// The sensors of a simulated vehicle as MAVLink messages. Private to vehicle.
#pragma once

#include <optional>

#include "flight/mavlink/messages.hpp"
#include "flight/mavlink/payload.hpp"
#include "flight/vehicle/reported_state.hpp"

namespace overfly::vehicle {

/// The payload of RAW_IMU, HIGHRES_IMU, SCALED_PRESSURE, AIRSPEED or DISTANCE_SENSOR; empty for
/// other messages. The sensors measure without errors.
[[nodiscard]] std::optional<flight::mavlink::PayloadWriter> sensor_payload_of(
    flight::mavlink::MessageId id, const VehicleReport& report);

}  // namespace overfly::vehicle
