// Light, detail and renderer of a scenario document, and their application to the world.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/result.hpp"
#include "server/scenario/scenario.hpp"
#include "terrain/world.hpp"

namespace overfly::server {

/// @pre the document is valid and has its defaults
/// Errors: kInvalidArgument with field, value and limit.
[[nodiscard]] Status read_light_and_detail(const nlohmann::json& document, Scenario& scenario);
void read_renderer(const nlohmann::json& document, Scenario& scenario);

/// The layers added to the world's own tiles, for people: ("light" or "detail", one line).
using WorldDress = std::vector<std::pair<std::string, std::string>>;
[[nodiscard]] Result<WorldDress> world_dress(const Scenario& scenario, const Geodetic& origin);

/// Applies the scenario's light to the world's tiles, then the detail.
/// Errors: kInvalidArgument if the sun is below the horizon at `light.time_utc`; as
/// terrain::with_light and with_detail.
[[nodiscard]] Status dress_world(const Scenario& scenario, terrain::World& world);

}  // namespace overfly::server
