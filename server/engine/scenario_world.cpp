#include "server/engine/scenario_world.hpp"

#include "terrain/synthesize.hpp"

namespace overfly::engine {
namespace {

Result<terrain::World> open_manifest(const std::filesystem::path& manifest) {
  const Result<terrain::WorldSpec> spec = terrain::read_world_manifest(manifest);
  if (!spec) return spec.error();
  return terrain::open_world(*spec);
}

}  // namespace

Result<terrain::World> open_scenario_world(const Scenario& scenario,
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

std::string world_key(const Scenario& scenario) {
  return scenario.resolved.value("data", "") + "|" +
         scenario.resolved.value("world", nlohmann::json::object()).dump();
}

}  // namespace overfly::engine
