// Reads the trajectories that a run has written.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>

#include "core/result.hpp"
#include "server/trajectories/served_trajectory.hpp"

namespace overfly::server {

/// @param part       "truth", "cameras/CAMERA", or an estimator's name
/// @param reference  the name of the trajectory in messages
/// Errors: kNotFound, also before the run ends; as read_trajectory.
[[nodiscard]] Result<ServedTrajectory> read_run_trajectory(const std::filesystem::path& folder,
                                                           const std::string& part,
                                                           const std::string& reference,
                                                           const std::atomic<bool>* cancel);

}  // namespace overfly::server
