// The scenario files of a folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server {

struct ScenarioEntry {
  std::string name;  ///< file name without .json
  std::filesystem::path file;
  std::string title;
  std::string description;
  std::string error;   ///< why it cannot be flown on this machine; empty if it can
  std::string flight;  ///< its kind: "course", "mission", ...; empty if it cannot be read
  bool saved = false;  ///< by a client of the server (SavedScenarios)
};

/// All `*.json` files that are scenarios (not schemas), sorted by name, each with the reason if it
/// cannot be flown on this machine.
/// @param sources  sources that they may name
[[nodiscard]] std::vector<ScenarioEntry> list_scenarios(const std::filesystem::path& folder,
                                                        const SourcePolicy& sources = {});

/// The folder itself and the folder `data` of each scenario in it, taken from the scenario file
/// without overrides. These are the folders that the owner of the scenarios opens to others.
[[nodiscard]] std::vector<std::filesystem::path> declared_folders(
    const std::filesystem::path& folder);

/// The file of a scenario name. Errors: kNotFound, also for a name that is not plain.
[[nodiscard]] Result<std::filesystem::path> scenario_path(const std::filesystem::path& folder,
                                                          const std::string& name);

/// A flight along a flight log begins at flight.log.from_s instead of start_s.
/// Errors: kInvalidArgument.
[[nodiscard]] Status check_start_of_log(const Scenario& scenario);

/// Checks what the schema cannot: whether the scenario's `sources` permit the files that it names,
/// and whether they exist.
/// Errors: as check_start_of_log, SourcePolicy::check and terrain::check_world_sources, every
/// invalid field on its own line; kNotFound if files are absent and nothing else is wrong.
[[nodiscard]] Status check_scenario(const Scenario& scenario);

}  // namespace overfly::server
