// The scenario files of a folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/engine/run_manager.hpp"
#include "server/engine/scenario.hpp"

namespace overfly::engine {

/// True for a name that is one plain part of a path: letters, digits, `_`, `-`, `.`, not first `.`.
[[nodiscard]] bool is_plain_name(const std::string& name);

/// All `*.json` that are scenarios (not schemas), by name, with why one cannot be flown here.
[[nodiscard]] std::vector<ScenarioEntry> list_scenarios(const std::filesystem::path& folder);

/// The file of a scenario name. Errors: kNotFound, also for what is no plain name.
[[nodiscard]] Result<std::filesystem::path> scenario_path(const std::filesystem::path& folder,
                                                          const std::string& name);

/// What the schema cannot see: whether the files that a scenario names are there.
/// Errors: kNotFound with every missing file and the field that names it, one a line.
[[nodiscard]] Status check_scenario(const Scenario& scenario);

}  // namespace overfly::engine
