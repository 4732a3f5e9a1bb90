// Faults that are taken out of a flight. The random numbers of a fault depend on its place in the
// list, so that those behind it must keep theirs.
#pragma once

#include <nlohmann/json.hpp>

namespace overfly::server::experiments {

/// Whether a fault begins before its flight ends.
[[nodiscard]] bool is_in_flight(const nlohmann::json& document, const nlohmann::json& fault);

/// Lets a fault begin later than any flight ends.
void move_out_of_flight(nlohmann::json& fault);

/// Removes from the end of a list of faults those that are not in the flight: none is behind them.
void remove_last_out_of_flight(const nlohmann::json& document, nlohmann::json& faults);

}  // namespace overfly::server::experiments
