// Pose files as flights: TUM, and CSV of geodetic positions and attitudes. Private to flight.
#pragma once

#include <filesystem>

#include "core/geodesy.hpp"
#include "core/result.hpp"
#include "core/trajectory.hpp"

namespace overfly::flight {

/// T_world_body over time, stamps as they stand in the file.
/// Errors: as fly_log.
[[nodiscard]] Result<Trajectory> read_log(const std::filesystem::path& file,
                                          const LocalFrame& frame,
                                          bool camera_poses);

}  // namespace overfly::flight
