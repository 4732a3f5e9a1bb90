// The worlds that clients of a server may fly over, by name.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/runs/run_manager.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server {

/// Manifests in a list.
inline constexpr std::size_t kMaxListedManifests = 500;

/// A world that a scenario may name. Names: `builtin:SEED`; `file:NAME` of a manifest in a data
/// folder, with NAME as of DataFile; `scenario:NAME` of a scenario that lists its layers, or whose
/// manifest is not in the list.
struct WorldEntry {
  std::string name;
  std::string title;
  nlohmann::json world;                  ///< value of `world` in a scenario, with absolute files
  bool made = true;                      ///< false: a built-in one that has to be made first
  std::vector<std::string> scenarios{};  ///< those over it, by their names
};

struct WorldList {
  std::vector<WorldEntry> worlds;
  bool complete = true;  ///< false: the data folders hold too many files to look at all
};

/// Built-in worlds of seed 1 and of scenarios, manifests in the data folders, layers of scenarios.
/// Equal worlds are listed once. Reads scenarios and manifests, but opens no world.
[[nodiscard]] WorldList list_worlds(RunManager& runs);

/// A scenario over the world of that name, without the light and detail of other scenarios.
/// Errors: kNotFound for every name that is no world's; as check_scenario.
[[nodiscard]] Result<Scenario> scenario_over(RunManager& runs, const std::string& name);

/// A scenario over the world of another one, alone: equal for all scenarios over the same files.
/// Errors: as check_scenario.
[[nodiscard]] Result<Scenario> world_of(RunManager& runs, const Scenario& scenario);

}  // namespace overfly::server
