// Inside terrain only: the files next to a raster that GDAL may treat as parts of it.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/outside/source_policy.hpp"

namespace overfly::terrain {

/// World files, headers, masks, overviews, statistics: files named as the raster, with another or
/// an additional extension. Each object lists a folder only once. Not thread-safe.
class SideCars {
 public:
  /// Whether all of them lie where the policy permits, with symbolic links resolved.
  /// Errors: as SourcePolicy::check_place, only the first error.
  [[nodiscard]] Status check(const std::filesystem::path& file,
                             const std::string& field,
                             const SourcePolicy& sources);
  /// A warning for each existing one that is not a regular file: GDAL does not see it.
  [[nodiscard]] std::vector<std::string> doubts(const std::filesystem::path& file);
  /// The existing ones. Each folder is listed once.
  [[nodiscard]] std::vector<std::filesystem::path> of(const std::filesystem::path& file);

 private:
  /// File names by their lower-case form, for the folders listed so far.
  std::map<std::filesystem::path, std::multimap<std::string, std::string>> folders_;
};

}  // namespace overfly::terrain
