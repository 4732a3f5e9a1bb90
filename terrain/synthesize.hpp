// The built-in world: a deterministic airfield landscape written as ordinary GeoTIFFs.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>

#include "core/result.hpp"

namespace overfly::terrain {

struct SynthesisOptions {
  std::uint64_t seed = 1;     ///< another seed gives another landscape
  double size_m = 4200.0;     ///< side of the square, in [500, 10000]
  double texel_m = 0.3;       ///< imagery resolution, in [0.1, 5]
  double center_lat_rad = 0;  ///< 0, 0 = the default place (39.35 N, 86.03 W)
  double center_lon_rad = 0;
  double relief_m = 40.0;  ///< height between valley and hilltop, in [0, 400]
};

/// Called with the share done in [0, 1]; returning false cancels.
using Progress = std::function<bool(double)>;

/// Writes imagery, elevation and manifest `world.json` into `folder` (complete or not at all:
/// files are renamed into place at the end). The same options give the same bytes.
/// Errors: kInvalidArgument naming the option, kIo, kCancelled.
[[nodiscard]] Status synthesize_world(const std::filesystem::path& folder,
                                      const SynthesisOptions& options,
                                      const Progress& progress = {});

/// The world in `folder`, synthesised if it does not exist yet. If two processes call it at the
/// same time, the second waits for the first (a lock file next to the folder).
/// Errors: as synthesize_world.
[[nodiscard]] Status ensure_world(const std::filesystem::path& folder,
                                  const SynthesisOptions& options,
                                  const Progress& progress = {});

/// The folder of the built-in world with this seed, whether it was made or not.
[[nodiscard]] std::filesystem::path builtin_world_folder(std::uint64_t seed);
/// The folder of the built-in world with this seed in the user's cache
/// ($OVERFLY_CACHE, else $XDG_CACHE_HOME/overfly, else ~/.cache/overfly), synthesised if absent.
[[nodiscard]] Result<std::filesystem::path> builtin_world(std::uint64_t seed,
                                                          const Progress& progress = {});

}  // namespace overfly::terrain
