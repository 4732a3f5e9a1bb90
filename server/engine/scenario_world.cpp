#include "server/engine/scenario_world.hpp"

#include "server/engine/scenario_light.hpp"
#include "terrain/synthesize.hpp"

namespace overfly::engine {
namespace {

Result<terrain::World> open_manifest(const std::filesystem::path& manifest) {
  const Result<terrain::WorldSpec> spec = terrain::read_world_manifest(manifest);
  if (!spec) return spec.error();
  return terrain::open_world(*spec);
}

Result<terrain::World> open_bare(const Scenario& scenario,
                                 const std::function<bool(double)>& progress) {
  if (const auto* builtin = std::get_if<Scenario::BuiltinWorld>(&scenario.world)) {
    const Result<std::filesystem::path> folder = terrain::builtin_world(builtin->seed, progress);
    if (!folder) return folder.error();
    return open_manifest(*folder / "world.json");
  }
  if (const auto* manifest = std::get_if<std::filesystem::path>(&scenario.world)) {
    return open_manifest(*manifest);
  }
  return terrain::open_world(std::get<terrain::WorldSpec>(scenario.world));
}

}  // namespace

Result<terrain::World> open_scenario_world(const Scenario& scenario,
                                           const std::function<bool(double)>& progress) {
  Result<terrain::World> world = open_bare(scenario, progress);
  if (!world) return world;
  if (Status status = dress_world(scenario, *world); !status) return status.error();
  return world;
}

std::string world_key(const Scenario& scenario) {
  std::string key = scenario.resolved.value("data", "");
  for (const char* field : {"world", "light", "detail"}) {
    key += '|';
    key += scenario.resolved.value(field, nlohmann::json::object()).dump();
  }
  return key;
}

}  // namespace overfly::engine
