// Pose files as flights: TUM, and CSV of geodetic positions and attitudes. Private to flight.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "core/geodesy.hpp"
#include "core/result.hpp"
#include "core/trajectory.hpp"

namespace overfly::flight {

struct FlightLog {
  Trajectory T_world_body;  ///< stamps as they stand in the file
  std::vector<std::string> warnings;
};

/// Rows that are not in order of time are sorted, and of those with the same time the first is
/// kept; `warnings` counts them.
/// Errors: as fly_log.
[[nodiscard]] Result<FlightLog> read_log(const std::filesystem::path& file,
                                         const LocalFrame& frame,
                                         bool camera_poses,
                                         const std::atomic<bool>* cancel = nullptr);

}  // namespace overfly::flight
