// The playback as parameters, for clients that have no controls for it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/net/foxglove/flight_feed.hpp"
#include "server/net/foxglove/server_message.hpp"

namespace overfly::net::foxglove {

/// `run`, `playing`, `live`, `loop`, `speed`, `t_s` and `alignment`.
[[nodiscard]] std::vector<Parameter> playback_parameters(const FlightFeed& feed);

/// Errors: kNotFound for an unknown name; kInvalidArgument for a value that does not fit, naming
/// the limit; kConflict for what the run does not have now.
[[nodiscard]] Status set_playback_parameter(const std::string& name,
                                            const nlohmann::json& value,
                                            FlightFeed* feed);

}  // namespace overfly::net::foxglove
