// Detects whether a run's world has changed since the flight.
#pragma once

#include <filesystem>
#include <string>

#include "server/worlds/scenario_world.hpp"

namespace overfly::server {

/// Compares the digests of the opened world's files with those in the run's manifest. Files above
/// 32 MiB are compared by samples.
/// @return the files that differ, for people; empty if none does or if the manifest has no digests
[[nodiscard]] std::string world_change(const std::filesystem::path& run_folder,
                                       const OpenedWorld& opened);

}  // namespace overfly::server
