#include "server/runs/scenario_library.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "server/files/plain_name.hpp"
#include "server/files/whole_file.hpp"
#include "server/scenario/document/estimators/estimator_reach.hpp"
#include "server/scenario/document/scenario_file.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

bool is_file(const fs::path& file) {
  std::error_code ignored;
  return fs::is_regular_file(file, ignored);
}

}  // namespace

Result<ScenarioLibrary::Found> ScenarioLibrary::find(const std::string& name) const {
  const Result<fs::path> owned = scenario_path(options_.folder, name);
  if (owned) return Found{*owned, false};
  if (options_.saved.empty()) return owned.error();
  const Result<fs::path> saved = scenario_path(options_.saved, name);
  if (!saved) return saved.error();
  return Found{*saved, true};
}

std::vector<ScenarioEntry> ScenarioLibrary::list() const {
  const SourcePolicy sources = options_.sources();
  std::vector<ScenarioEntry> all = list_scenarios(options_.folder, sources);
  if (options_.saved.empty()) return all;
  std::set<std::string> names;
  for (const ScenarioEntry& entry : all) names.insert(entry.name);
  for (ScenarioEntry& entry : list_scenarios(options_.saved, sources)) {
    if (names.contains(entry.name)) continue;
    entry.saved = true;
    all.push_back(std::move(entry));
  }
  return all;
}

Result<fs::path> ScenarioLibrary::file(const std::string& name) const {
  Result<Found> found = find(name);
  if (!found) return found.error();
  return std::move(found->file);
}

Result<Json> ScenarioLibrary::document(const std::string& name) const {
  const Result<Found> found = find(name);
  if (!found) return found.error();
  Result<Scenario> loaded = load_scenario(found->file, {}, options_.sources());
  if (!loaded) return loaded.error();
  return std::move(loaded->resolved);
}

Result<Scenario> ScenarioLibrary::load(const std::string& name) const {
  const Result<Found> found = find(name);
  if (!found) return found.error();
  return load(*found, {});
}

Result<Scenario> ScenarioLibrary::load(const Found& found,
                                       const std::vector<Override>& overrides) const {
  const SourcePolicy sources = options_.sources();
  Result<Scenario> loaded = load_scenario(found.file, overrides, sources);
  if (!loaded) return loaded.error();
  loaded->sources = sources;
  if (Status status = check_scenario(*loaded); !status) return status.error();
  return loaded;
}

Result<Scenario> ScenarioLibrary::read(const Json& document) const {
  const SourcePolicy sources = options_.sources();
  const fs::path base = fs::absolute(options_.folder).lexically_normal();
  Result<Scenario> scenario = resolve_scenario(document, {}, base, sources);
  if (!scenario) return scenario.error();
  scenario->sources = sources;
  if (Status status = check_scenario(*scenario); !status) return status.error();
  return scenario;
}

// What is checked is what will be flown: a file that clients write may differ the next time it is
// read.

Result<Scenario> ScenarioLibrary::load_to_fly(const std::string& name,
                                              const std::vector<Override>& overrides) const {
  const Result<Found> found = find(name);
  if (!found) return found.error();
  Result<Scenario> loaded = load(*found, overrides);
  if (!loaded) return loaded;
  if (Status reach = check_reach(*loaded, *found, overrides); !reach) return reach.error();
  return loaded;
}

Result<Scenario> ScenarioLibrary::read_to_fly(const Json& document) const {
  Result<Scenario> scenario = read(document);
  if (!scenario) return scenario;
  if (Status reach = check_reach(*scenario); !reach) return reach.error();
  return scenario;
}

/// Compares with all of the owner's scenarios together.
std::function<Status(const Scenario&)> ScenarioLibrary::reach_check() const {
  if (options_.allow_commands) return [](const Scenario&) { return Status(); };
  std::vector<Scenario> trusted;
  for (const ScenarioEntry& entry : list_scenarios(options_.folder, options_.sources())) {
    Result<Scenario> owned = load_scenario(entry.file, {}, options_.sources());
    if (owned) trusted.push_back(std::move(*owned));
  }
  return [trusted = std::move(trusted)](const Scenario& scenario) {
    return server::check_reach(scenario, trusted);
  };
}

Status ScenarioLibrary::check_reach(const Scenario& wanted) const {
  // Most scenarios need no trust, and then the owner's need not be read.
  if (options_.allow_commands || server::check_reach(wanted, {}).ok()) return {};
  return reach_check()(wanted);
}

Status ScenarioLibrary::check_reach(const Scenario& wanted,
                                    const Found& found,
                                    const std::vector<Override>& overrides) const {
  if (options_.allow_commands) return {};
  if (found.saved) return check_reach(wanted);
  if (overrides.empty()) return {};
  // If the file itself is invalid and only the overrides make it valid, nothing in it is trusted.
  const Result<Scenario> trusted = load_scenario(found.file, {}, options_.sources());
  return server::check_reach(wanted, {trusted ? *trusted : Scenario()});
}

Status ScenarioLibrary::check_name(const std::string& name,
                                   bool replace,
                                   SaveRefusal& refusal) const {
  if (options_.saved.empty()) {
    refusal = SaveRefusal::kOff;
    return Error{ErrorCode::kConflict, "this server keeps no scenarios of its clients"};
  }
  if (!is_given_name(name)) {
    return Error{ErrorCode::kInvalidArgument,
                 "name = " + name.substr(0, 100) + ": " + kGivenNameRule};
  }
  if (is_file(options_.folder / (name + ".json"))) {
    refusal = SaveRefusal::kOwned;
    return Error{ErrorCode::kConflict,
                 "scenario \"" + name + "\" belongs to the server: choose another name"};
  }
  const bool exists = is_file(options_.saved / (name + ".json"));
  if (exists && !replace) {
    return Error{ErrorCode::kConflict, "scenario \"" + name + "\" exists"};
  }
  if (exists) return {};
  std::error_code failed;
  const fs::directory_iterator entries(options_.saved, failed);
  const auto count = failed ? 0 : std::distance(begin(entries), end(entries));
  if (static_cast<std::size_t>(count) < kMaxSavedScenarios) return {};
  refusal = SaveRefusal::kFull;
  return Error{ErrorCode::kConflict,
               "saved scenarios = " + std::to_string(count) + ": must be below " +
                   std::to_string(kMaxSavedScenarios) + ": delete some of them"};
}

Result<bool> ScenarioLibrary::save(const std::string& name,
                                   const Json& document,
                                   bool replace,
                                   SaveRefusal& refusal) {
  const std::lock_guard lock(saving_);
  if (Status status = check_name(name, replace, refusal); !status) return status.error();
  Json named = document;
  if (named.is_object()) named["name"] = name;
  Result<Scenario> scenario = read_to_fly(named);
  if (!scenario) return scenario.error();
  const fs::path file = options_.saved / (name + ".json");
  const std::string text =
      scenario->resolved.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  if (text.size() > kMaxSavedScenarioBytes) {
    return Error{ErrorCode::kInvalidArgument,
                 "scenario = " + std::to_string(text.size()) + " bytes: must be at most " +
                     std::to_string(kMaxSavedScenarioBytes)};
  }
  const bool is_new = !is_file(file);
  std::error_code failed;
  fs::create_directories(options_.saved, failed);
  if (failed) return Error{ErrorCode::kIo, options_.saved.string() + ": " + failed.message()};
  if (Status status = write_whole(file, text); !status) return status.error();
  return is_new;
}

Status ScenarioLibrary::remove(const std::string& name, SaveRefusal& refusal) {
  const std::lock_guard lock(saving_);
  const Result<Found> found = find(name);
  if (!found) return found.error();
  if (!found->saved) {
    refusal = SaveRefusal::kOwned;
    return Error{ErrorCode::kConflict, "scenario \"" + name + "\" belongs to the server"};
  }
  std::error_code failed;
  fs::remove(found->file, failed);
  if (failed) return Error{ErrorCode::kIo, found->file.string() + ": " + failed.message()};
  return {};
}

}  // namespace overfly::server
