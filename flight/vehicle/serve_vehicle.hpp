// Runs a simulated vehicle on a link, by the wall clock.
#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "core/result.hpp"
#include "flight/mavlink/link/frame_link.hpp"
#include "flight/vehicle/simulated_vehicle.hpp"

namespace overfly::vehicle {

/// Flies until `stop` is set: steps the vehicle `speed_up` times as fast as the wall clock, and
/// passes messages on. If the machine is too slow, the vehicle's clock falls behind instead of
/// catching up in a burst.
/// @param speed_up  (0, 100]
/// @param opened    called once with the link's address, with the actual port
/// Errors: as FrameLink::create.
[[nodiscard]] Status serve_vehicle(
    SimulatedVehicle& vehicle,
    const flight::mavlink::LinkAddress& address,
    double speed_up,
    const std::atomic<bool>& stop,
    const std::function<void(const flight::mavlink::LinkAddress&)>& opened);

}  // namespace overfly::vehicle
