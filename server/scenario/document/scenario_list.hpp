// The scenario files of a folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::engine {

struct ScenarioEntry {
  std::string name;  ///< file name without .json
  std::filesystem::path file;
  std::string title;
  std::string description;
  std::string error;  ///< why it cannot be flown here; empty when it can
};

/// All `*.json` that are scenarios (not schemas), by name, with why one cannot be flown here.
/// @param sources  what they may name
[[nodiscard]] std::vector<ScenarioEntry> list_scenarios(const std::filesystem::path& folder,
                                                        const SourcePolicy& sources = {});

/// The folder itself and the folder `data` of each scenario in it, as its file alone says it: the
/// folders whose files whoever keeps these scenarios lets others fly over.
[[nodiscard]] std::vector<std::filesystem::path> declared_folders(
    const std::filesystem::path& folder);

/// The file of a scenario name. Errors: kNotFound, also for what is no plain name.
[[nodiscard]] Result<std::filesystem::path> scenario_path(const std::filesystem::path& folder,
                                                          const std::string& name);

/// What the schema cannot see: whether the files that a scenario names may be named, by its
/// `sources`, and are there.
/// Errors: as SourcePolicy::check and terrain::check_world_sources, every fault with its field on a
/// line; kNotFound where files are absent and nothing else is wrong.
[[nodiscard]] Status check_scenario(const Scenario& scenario);

}  // namespace overfly::engine
