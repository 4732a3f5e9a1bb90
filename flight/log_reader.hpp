// Reads pose files as flights: TUM, and CSV with geodetic positions and attitudes. Private to
// flight.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "core/earth/geodesy.hpp"
#include "core/motion/trajectory.hpp"
#include "core/result.hpp"

namespace overfly::flight {

struct FlightLog {
  Trajectory T_world_body;  ///< stamps as in the file
  std::vector<std::string> warnings;
};

/// Sorts rows by time and keeps the first of several with the same time; `warnings` reports how
/// many were moved or dropped, and how long the gaps of rows without a pose are.
/// Errors: as fly_log.
[[nodiscard]] Result<FlightLog> read_log(const std::filesystem::path& file,
                                         const LocalFrame& frame,
                                         bool camera_poses,
                                         const std::atomic<bool>* cancel = nullptr);

}  // namespace overfly::flight
