// The checks of `overfly doctor`.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace overfly::app {

enum class CheckLevel {
  kOk,
  kWarning,  ///< something optional is missing
  kFault,    ///< nothing can be flown
};

struct Check {
  std::string name;  ///< file name without .json
  CheckLevel level = CheckLevel::kOk;
  std::string finding;
  std::string remedy;  ///< empty when all is well
};

/// @param runs_folder  where runs would be written
[[nodiscard]] std::vector<Check> all_checks(const std::filesystem::path& runs_folder);
[[nodiscard]] nlohmann::json json_from(const std::vector<Check>& checks);

}  // namespace overfly::app
