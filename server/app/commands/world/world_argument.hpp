// Opens the world given as a command line option.
#pragma once

#include <string>

#include "core/result.hpp"
#include "terrain/world.hpp"

namespace overfly::app {

/// `builtin`, `builtin:SEED`, a manifest, a folder with a world.json, or an imagery file (over flat
/// ground at ellipsoidal height 0). Errors: as terrain::open_world.
[[nodiscard]] Result<terrain::World> open_world_argument(const std::string& text);

inline constexpr const char* kWorldHelp =
    "Manifest, folder with a world.json, imagery file, builtin or builtin:SEED";

}  // namespace overfly::app
