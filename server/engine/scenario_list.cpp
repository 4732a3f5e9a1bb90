#include "server/engine/scenario_list.hpp"

#include <algorithm>

#include "server/engine/whole_file.hpp"

namespace overfly::engine {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSchemaSuffix = ".schema.json";

ScenarioEntry entry_of(const fs::path& file) {
  ScenarioEntry entry;
  entry.name = file.stem().string();
  entry.file = file;
  entry.title = entry.name;
  const Result<Scenario> scenario = load_scenario(file);
  if (!scenario) {
    entry.error = scenario.error().message;
    return entry;
  }
  entry.title = scenario->title;
  entry.description = scenario->description;
  if (Status status = check_scenario(*scenario); !status) entry.error = status.error().message;
  return entry;
}

void require_file(const fs::path& file, const std::string& field, std::string& missing) {
  std::error_code ignored;
  if (fs::is_regular_file(file, ignored)) return;
  if (!missing.empty()) missing += '\n';
  missing += field + " = " + file.string() + ": no such file";
}

}  // namespace

bool is_plain_name(const std::string& name) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  return !name.empty() && name.size() <= 200 && name.front() != '.' &&
         std::all_of(name.begin(), name.end(), allowed);
}

std::vector<ScenarioEntry> list_scenarios(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() != ".json" || name.ends_with(kSchemaSuffix)) continue;
    if (is_plain_name(name)) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<ScenarioEntry> entries;
  entries.reserve(files.size());
  for (const fs::path& file : files) entries.push_back(entry_of(file));
  return entries;
}

Result<fs::path> scenario_path(const fs::path& folder, const std::string& name) {
  fs::path file = folder / (name + ".json");
  std::error_code ignored;
  if (!is_plain_name(name) || name.ends_with(".schema") || !fs::is_regular_file(file, ignored)) {
    return Error{ErrorCode::kNotFound, "scenario \"" + name + "\": no such scenario"};
  }
  return file;
}

Status check_scenario(const Scenario& scenario) {
  std::string missing;
  if (const auto* manifest = std::get_if<fs::path>(&scenario.world)) {
    require_file(*manifest, "world.manifest", missing);
  } else if (const auto* spec = std::get_if<terrain::WorldSpec>(&scenario.world)) {
    for (std::size_t i = 0; i < spec->imagery.size(); ++i) {
      require_file(spec->imagery[i].file, "world.imagery." + std::to_string(i) + ".file", missing);
    }
    for (std::size_t i = 0; i < spec->elevation.size(); ++i) {
      require_file(
          spec->elevation[i].file, "world.elevation." + std::to_string(i) + ".file", missing);
    }
  }
  if (const auto* log = std::get_if<Scenario::LoggedFlight>(&scenario.flight)) {
    require_file(log->file, "flight.log.file", missing);
  }
  if (missing.empty()) return {};
  if (scenario.resolved.contains("data")) {
    missing += "\n(data folder: " + scenario.resolved.value("data", "") +
               "; the environment variable OVERFLY_DATA names another one)";
  }
  return Error{ErrorCode::kNotFound, missing};
}

}  // namespace overfly::engine
