// The events of a recorded flight.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "core/motion/flight_event.hpp"
#include "core/result.hpp"

namespace overfly::server {

/// Modes, mission items and other events in the log of a run folder, by time. Of other events only
/// the first `max_others`.
/// Errors: as read_lines; kUnreadable naming file and row.
[[nodiscard]] Result<std::vector<FlightEvent>> read_recorded_events(
    const std::filesystem::path& run_folder, std::size_t max_others);

}  // namespace overfly::server
