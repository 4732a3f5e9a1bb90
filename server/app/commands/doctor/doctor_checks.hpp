// The checks of `overfly doctor`.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace overfly::app {

enum class CheckLevel {
  kOk,
  kWarning,  ///< an optional part is missing
  kFault,    ///< no flight is possible
};

struct Check {
  std::string name;  ///< file name without .json
  CheckLevel level = CheckLevel::kOk;
  std::string finding;
  std::string remedy;  ///< empty if the check passed
};

/// @param runs_folder  folder in which runs would be written
[[nodiscard]] std::vector<Check> all_checks(const std::filesystem::path& runs_folder);
[[nodiscard]] nlohmann::json json_from(const std::vector<Check>& checks);

}  // namespace overfly::app
