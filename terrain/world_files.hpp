// The files that a world is read from, so that another version of them is noticed.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "terrain/file_identity.hpp"

namespace overfly::terrain {

struct WorldSpec;

struct WorldFile {
  std::filesystem::path file;  ///< absolute
  /// Empty: it was not there. GDAL would read it if it came (a side-car, a mask, overviews).
  std::optional<FileIdentity> identity;
};

/// The layers' files, their side-cars and the sources of virtual rasters, as they are now. What
/// cannot be opened is left to whoever opens it to complain about.
[[nodiscard]] std::vector<WorldFile> world_files(const WorldSpec& spec);

/// The first of the files that is another now, came or went; empty where all are as they were.
[[nodiscard]] std::optional<std::filesystem::path> changed_file(
    const std::vector<WorldFile>& files);
/// The same, but for files that came.
[[nodiscard]] std::optional<std::filesystem::path> lost_file(const std::vector<WorldFile>& files);

}  // namespace overfly::terrain
