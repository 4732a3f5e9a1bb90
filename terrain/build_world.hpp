// Prepares a world so that it opens and reads fast: stores all tiles and heights in a cache next to
// the manifest.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "terrain/build_progress.hpp"
#include "terrain/world.hpp"

namespace overfly::terrain {

struct BuildReport {
  std::filesystem::path folder;  ///< of the cache in use
  bool was_fresh = false;        ///< the cache was up to date
  std::uint64_t bytes = 0;       ///< of the cache
  int chunks_made = 0;
  int chunks_kept = 0;  ///< from an earlier, interrupted build
  std::vector<std::string> warnings;
};

/// Fills `spec.cache_folder` with the tiles of all levels and the heights, byte-identical to those
/// read from the files. Parts are written whole: an interrupted or killed build resumes where it
/// stopped, and two processes may build at the same time. Caches of other states of the files are
/// removed at the end.
/// Errors: as open_world; kIo; kCancelled; kInvalidArgument without a cache folder.
[[nodiscard]] Result<BuildReport> build_world(const WorldSpec& spec,
                                              const BuildProgress& progress = {});

/// Whether two worlds consist of the same files, read in the same way.
[[nodiscard]] bool same_layers(const WorldSpec& a, const WorldSpec& b);

}  // namespace overfly::terrain
