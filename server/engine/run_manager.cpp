#include "server/engine/run_manager.hpp"

#include <algorithm>
#include <utility>

#include "server/engine/run_manager_impl.hpp"
#include "server/engine/scenario_estimators.hpp"

namespace overfly::engine {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

Error no_such_run(const std::string& id) {
  return {ErrorCode::kNotFound, "run \"" + id + "\": no such run"};
}

}  // namespace

RunManager::RunManager() = default;
RunManager::~RunManager() = default;

Result<std::unique_ptr<RunManager>> RunManager::create(RunManagerOptions options) {
  if (options.max_parallel_runs < 1) {
    return Error{ErrorCode::kInvalidArgument,
                 "max_parallel_runs = " + std::to_string(options.max_parallel_runs) +
                     ": must be at least 1"};
  }
  std::error_code failure;
  fs::create_directories(options.runs_folder, failure);
  if (failure) {
    return Error{ErrorCode::kIo, options.runs_folder.string() + ": " + failure.message()};
  }
  if (!fs::is_directory(options.scenarios_folder)) {
    return Error{ErrorCode::kNotFound,
                 options.scenarios_folder.string() + ": no such folder of scenarios"};
  }
  std::unique_ptr<RunManager> manager(new RunManager());
  manager->impl_ = std::make_unique<Impl>(std::move(options));
  return manager;
}

Result<RunInfo> RunManager::start(const std::string& scenario,
                                  const std::vector<Override>& overrides,
                                  const std::string& idempotency_key) {
  if (!idempotency_key.empty()) {
    if (std::optional<RunInfo> earlier = impl_->started_by(idempotency_key)) return *earlier;
  }
  const Result<fs::path> file = scenario_path(impl_->options.scenarios_folder, scenario);
  if (!file) return file.error();
  Result<Scenario> loaded = load_scenario(*file, overrides);
  if (!loaded) return loaded.error();
  loaded->sources = impl_->sources();
  if (Status status = check_scenario(*loaded); !status) return status.error();
  return impl_->enqueue(std::move(*loaded), idempotency_key);
}

Status RunManager::check_overrides(const std::string& scenario,
                                   const std::vector<Override>& overrides) const {
  if (impl_->options.allow_commands || overrides.empty()) return {};
  const Result<fs::path> file = scenario_path(impl_->options.scenarios_folder, scenario);
  if (!file) return {};
  const Result<Scenario> trusted = load_scenario(*file);
  const Result<Scenario> wanted = load_scenario(*file, overrides);
  // A file at fault that its overrides mend is trusted with nothing.
  return wanted ? check_reach(*wanted, trusted ? *trusted : Scenario()) : Status();
}

std::vector<ScenarioEntry> RunManager::scenarios() const {
  return list_scenarios(impl_->options.scenarios_folder, impl_->sources());
}

Result<Json> RunManager::scenario(const std::string& name) const {
  const Result<fs::path> file = scenario_path(impl_->options.scenarios_folder, name);
  if (!file) return file.error();
  Result<Scenario> loaded = load_scenario(*file);
  if (!loaded) return loaded.error();
  return loaded->resolved;
}

std::vector<RunInfo> RunManager::runs() const {
  std::vector<RunInfo> infos = impl_->active_infos();
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(impl_->options.runs_folder, ignored)) {
    const std::string id = entry.path().filename().string();
    const bool known =
        std::any_of(infos.begin(), infos.end(), [&](const RunInfo& info) { return info.id == id; });
    if (known || !is_plain_name(id) || !entry.is_directory(ignored)) continue;
    if (Result<RunInfo> info = read_run_info(entry.path()); info) infos.push_back(*info);
  }
  std::sort(infos.begin(), infos.end(), [](const RunInfo& a, const RunInfo& b) {
    return std::tie(a.created_utc, a.id) > std::tie(b.created_utc, b.id);
  });
  return infos;
}

Result<std::shared_ptr<RunTimeline>> RunManager::timeline(const std::string& id) {
  if (std::shared_ptr<RunTimeline> known = impl_->known_timeline(id)) return known;
  const Result<fs::path> place = folder(id);
  if (!place) return place.error();
  Result<std::shared_ptr<RunTimeline>> opened = RunTimeline::open(*place);
  // A run that another process still writes is read anew each time.
  if (opened && opened.value()->info().status != RunStatus::kRunning) {
    impl_->remember(id, *opened);
  }
  return opened;
}

Status RunManager::cancel(const std::string& id) {
  if (impl_->cancel(id)) return {};
  if (const Result<fs::path> place = folder(id); !place && !impl_->known_timeline(id)) {
    return place.error();
  }
  return Error{ErrorCode::kConflict, "run \"" + id + "\" is neither queued nor running here"};
}

Status RunManager::remove(const std::string& id) {
  if (impl_->is_live(id)) {
    return Error{ErrorCode::kConflict, "run \"" + id + "\" is not over: cancel it first"};
  }
  const Result<fs::path> place = folder(id);
  if (!place) {
    // A run cancelled while it waited never had a folder.
    return impl_->forget(id) ? Status{} : Status{place.error()};
  }
  if (RunLock::held(*place)) {
    return Error{ErrorCode::kConflict, "run \"" + id + "\" is being written by another process"};
  }
  std::error_code failure;
  fs::remove_all(*place, failure);
  if (failure) return Error{ErrorCode::kIo, place->string() + ": " + failure.message()};
  impl_->forget(id);
  return {};
}

Result<fs::path> RunManager::folder(const std::string& id) const {
  if (!is_plain_name(id)) return no_such_run(id);
  fs::path place = impl_->options.runs_folder / id;
  std::error_code ignored;
  if (!fs::exists(manifest_file(place), ignored)) return no_such_run(id);
  return place;
}

Result<Scenario> RunManager::scenario_of(const std::string& id) const {
  if (std::optional<Scenario> scenario = impl_->active_scenario(id)) return *scenario;
  const Result<fs::path> place = folder(id);
  if (!place) return place.error();
  Result<Scenario> flown = load_scenario(scenario_file(*place));
  if (!flown) return flown.error();
  flown->sources = impl_->sources();
  if (Status status = check_scenario(*flown); !status) return status.error();
  return flown;
}

Result<std::shared_ptr<const terrain::World>> RunManager::world_of(const std::string& id) {
  if (const auto flown = impl_->flown_world(id)) return bare_world(flown);
  const Result<Scenario> scenario = scenario_of(id);
  if (!scenario) return scenario.error();
  const auto opened = impl_->worlds.get(*scenario, {});
  if (!opened) return opened.error();
  return bare_world(*opened);
}

PictureRate& RunManager::picture_rate() { return impl_->picture_rate; }

const RendererFactory& RunManager::renderer_factory() const {
  return impl_->options.renderer_factory;
}

}  // namespace overfly::engine
