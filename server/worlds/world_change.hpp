// Whether a run's world is still as it was flown.
#pragma once

#include <filesystem>
#include <string>

#include "server/worlds/scenario_world.hpp"

namespace overfly::engine {

/// Compares the digests of the opened world's files with those in the run's manifest.
/// @return which files differ, for people; empty where none does and where the manifest has none.
/// Of files above 32 MiB the digests are samples.
[[nodiscard]] std::string world_change(const std::filesystem::path& run_folder,
                                       const OpenedWorld& opened);

}  // namespace overfly::engine
