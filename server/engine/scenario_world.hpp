// The world that a scenario names, opened.
#pragma once

#include <functional>
#include <string>

#include "core/result.hpp"
#include "server/engine/scenario.hpp"
#include "terrain/world.hpp"

namespace overfly::engine {

/// Opens the scenario's world; makes the built-in one if this machine does not have it yet.
/// @param progress  called with the share done in [0, 1] while it is made; false cancels
/// Errors: as terrain::open_world, read_world_manifest and builtin_world.
[[nodiscard]] Result<terrain::World> open_scenario_world(
    const Scenario& scenario, const std::function<bool(double)>& progress = {});

/// Equal for scenarios over the same world.
[[nodiscard]] std::string world_key(const Scenario& scenario);

}  // namespace overfly::engine
