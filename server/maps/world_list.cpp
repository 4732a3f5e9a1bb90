#include "server/maps/world_list.hpp"

#include <charconv>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "server/files/data_files.hpp"
#include "server/worlds/scenario_world.hpp"
#include "terrain/world.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kBuiltin = "builtin:";
constexpr const char* kFile = "file:";
constexpr const char* kScenario = "scenario:";

bool is_manifest_name(const std::string& name) { return name.ends_with(".json"); }

ServedFolders folders_of(const RunManager& runs) {
  DataFolders data = runs.data_folders();
  return {{}, std::move(data.folders), std::move(data.sources)};
}

Json builtin_json(std::uint64_t seed) { return {{"builtin", {{"seed", seed}}}}; }
Json manifest_json(const fs::path& file) { return {{"manifest", file.string()}}; }

/// The scenario's world with absolute files.
Json listed_world(const Scenario& scenario) {
  if (const auto* builtin = std::get_if<Scenario::BuiltinWorld>(&scenario.world)) {
    return builtin_json(builtin->seed);
  }
  if (const auto* manifest = std::get_if<fs::path>(&scenario.world))
    return manifest_json(*manifest);
  const auto& layers = std::get<terrain::WorldSpec>(scenario.world);
  Json world = scenario.resolved.at("world");
  for (std::size_t i = 0; i < layers.imagery.size(); ++i) {
    world["imagery"][i]["file"] = layers.imagery[i].file.string();
  }
  for (std::size_t i = 0; i < layers.elevation.size(); ++i) {
    world["elevation"][i]["file"] = layers.elevation[i].file.string();
  }
  return world;
}

Result<Scenario> scenario_with(RunManager& runs, const Json& world) {
  return runs.library().read(
      {{"format_version", 1}, {"world", world}, {"flight", {{"course", Json::object()}}}});
}

std::optional<std::uint64_t> seed_of(const std::string& text) {
  std::uint64_t seed = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, seed);
  constexpr std::uint64_t kLargest = 9'007'199'254'740'991;  // as in the schema
  if (error != std::errc() || rest != end || seed > kLargest) return std::nullopt;
  return seed;
}

Error no_such_world(const std::string& name) {
  return {ErrorCode::kNotFound, "world \"" + name + "\": no such world"};
}

/// Collects worlds; equal ones are listed once.
class WorldLister {
 public:
  explicit WorldLister(RunManager& runs) : runs_(runs) {}

  WorldList list() {
    add_builtin(1);
    add_manifests();
    for (const ScenarioEntry& entry : runs_.library().list()) add_world_of(entry);
    return std::move(list_);
  }

 private:
  /// The entry of this world, which may be an earlier one.
  WorldEntry& add(WorldEntry entry) {
    const auto [known, is_new] = known_.emplace(entry.world.dump(), list_.worlds.size());
    if (is_new) list_.worlds.push_back(std::move(entry));
    return list_.worlds[known->second];
  }
  WorldEntry& add_builtin(std::uint64_t seed) {
    const std::string number = std::to_string(seed);
    WorldEntry entry{kBuiltin + number, "Built-in airfield, seed " + number, builtin_json(seed)};
    if (const auto scenario = scenario_with(runs_, entry.world)) {
      entry.made = !world_must_be_made(*scenario);
    }
    return add(std::move(entry));
  }
  void add_manifests() {
    const ServedFolders folders = folders_of(runs_);
    std::size_t manifests = 0;
    list_.complete = visit_data_files(folders, is_manifest_name, [&](const DataFile& file) {
      const auto spec = terrain::read_world_manifest(file.path, folders.sources);
      if (!spec) return true;  // another document, or a manifest at fault
      add({kFile + file.name,
           spec->name.empty() ? file.name : spec->name,
           manifest_json(file.path.lexically_normal())});
      return ++manifests < kMaxListedManifests;
    });
  }
  void add_world_of(const ScenarioEntry& entry) {
    const auto scenario = runs_.library().load(entry.name);
    if (!scenario) return;
    const auto* builtin = std::get_if<Scenario::BuiltinWorld>(&scenario->world);
    WorldEntry& world =
        builtin != nullptr
            ? add_builtin(builtin->seed)
            : add({kScenario + entry.name, "World of " + entry.title, listed_world(*scenario)});
    world.scenarios.push_back(entry.name);
  }

  RunManager& runs_;
  WorldList list_;
  std::map<std::string, std::size_t> known_;  // index in the list by the world's text
};

}  // namespace

WorldList list_worlds(RunManager& runs) { return WorldLister(runs).list(); }

Result<Scenario> scenario_over(RunManager& runs, const std::string& name) {
  if (name.starts_with(kBuiltin)) {
    const auto seed = seed_of(name.substr(std::string(kBuiltin).size()));
    if (!seed) return no_such_world(name);
    return scenario_with(runs, builtin_json(*seed));
  }
  if (name.starts_with(kFile)) {
    const std::string file_name = name.substr(std::string(kFile).size());
    const auto file = find_data_file(folders_of(runs), file_name, is_manifest_name);
    if (!file) return no_such_world(name);
    return scenario_with(runs, manifest_json(file->lexically_normal()));
  }
  if (name.starts_with(kScenario)) {
    const auto scenario = runs.library().load(name.substr(std::string(kScenario).size()));
    if (!scenario) {
      return scenario.error().code == ErrorCode::kNotFound ? no_such_world(name) : scenario.error();
    }
    return world_of(runs, *scenario);
  }
  return no_such_world(name);
}

Result<Scenario> world_of(RunManager& runs, const Scenario& scenario) {
  return scenario_with(runs, listed_world(scenario));
}

}  // namespace overfly::server
