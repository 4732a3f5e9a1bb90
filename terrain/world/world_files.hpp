// The files that a world is read from, used to detect changes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "terrain/files/file_identity.hpp"

namespace overfly::terrain {

struct WorldSpec;

struct WorldFile {
  std::filesystem::path file;  ///< absolute
  /// Empty if it did not exist. GDAL would read it if it appeared (a side-car, a mask, overviews).
  std::optional<FileIdentity> identity;
};

/// The layers' files, the sources of virtual rasters, and the side-cars of both, present or not.
/// What a file that cannot be opened consists of is not listed; opening the world reports it.
[[nodiscard]] std::vector<WorldFile> world_files(const WorldSpec& spec);

/// The first of the files that was changed, created or removed; empty if all are unchanged.
[[nodiscard]] std::optional<std::filesystem::path> changed_file(
    const std::vector<WorldFile>& files);
/// The same, except for files that were created.
[[nodiscard]] std::optional<std::filesystem::path> lost_file(const std::vector<WorldFile>& files);

}  // namespace overfly::terrain
