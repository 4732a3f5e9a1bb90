// Inside terrain only: the files beside a raster that GDAL may take for parts of it.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/source_policy.hpp"

namespace overfly::terrain {

/// World files, headers, masks, overviews, statistics: whatever is named as the raster, with
/// another ending or one more. Lists each folder once in its life. Not thread-safe.
class SideCars {
 public:
  /// Whether all of them lie where the policy allows, with links resolved.
  /// Errors: as SourcePolicy::check_place, the first fault alone.
  [[nodiscard]] Status check(const std::filesystem::path& file,
                             const std::string& field,
                             const SourcePolicy& sources);
  /// A warning for each that is there but no regular file: GDAL does not see it.
  [[nodiscard]] std::vector<std::string> doubts(const std::filesystem::path& file);

 private:
  [[nodiscard]] std::vector<std::filesystem::path> of(const std::filesystem::path& file);

  /// Names by themselves in lower case, of the folders seen.
  std::map<std::filesystem::path, std::multimap<std::string, std::string>> folders_;
};

}  // namespace overfly::terrain
