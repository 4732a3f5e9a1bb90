// What a vehicle must have before estimates are sent to it.
#pragma once

#include "core/earth/geodesy.hpp"
#include "core/result.hpp"
#include "flight/mavlink/feedback/feedback_options.hpp"
#include "flight/mavlink/vehicle/exchange.hpp"

namespace overfly::flight::mavlink {

/// Asks for the origin of the vehicle's local positions, and sets it if that is wanted and there is
/// none. Checks, with ArduPilot, that its height does not follow a height that is not measured:
/// EK3_SRC1_POSZ must not be the source of the message.
/// @param origin  to set: height above mean sea level
/// Errors: as run_command and read_parameter; kConflict naming the parameter, or if there is no
/// origin.
[[nodiscard]] Status prepare_feedback(Exchange& exchange,
                                      const FeedbackOptions& options,
                                      const GlobalPosition& origin);

}  // namespace overfly::flight::mavlink
