// Makes a world quick to open and to read: all tiles and heights ready in a cache beside the
// manifest.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "terrain/world.hpp"

namespace overfly::terrain {

struct BuildReport {
  std::filesystem::path folder;  ///< of the cache in use
  bool was_fresh = false;        ///< nothing had to be done
  std::uint64_t bytes = 0;       ///< of the cache
  int chunks_made = 0;
  int chunks_kept = 0;  ///< of an earlier build that was stopped
  std::vector<std::string> warnings;
};

/// Called now and then with the done share in [0, 1]; returning false cancels.
using BuildProgress = std::function<bool(double share, const std::string& doing)>;

/// Fills `spec.cache_folder`: tiles of all levels and heights, byte for byte what reading the files
/// gives. Parts are written whole, so that a stopped or killed build goes on where it was; two
/// processes may build at once. Caches of other states of the files are removed at the end.
/// Errors: those of open_world; kIo; kCancelled; kInvalidArgument without a cache folder.
[[nodiscard]] Result<BuildReport> build_world(const WorldSpec& spec,
                                              const BuildProgress& progress = {});

/// A world of files, imagery and elevation told apart by content: heights have one band that is
/// not 8 bit; pictures have colours or 8 bits. The finest comes first of either kind.
/// Errors: kInvalidArgument naming a file that could be both (one band of 16-bit whole numbers
/// without a unit), or when there is no imagery; kNotFound; kUnreadable.
[[nodiscard]] Result<WorldSpec> world_from_files(const std::vector<std::filesystem::path>& files);

/// Whether two worlds are made of the same files, read in the same way.
[[nodiscard]] bool same_layers(const WorldSpec& a, const WorldSpec& b);

}  // namespace overfly::terrain
