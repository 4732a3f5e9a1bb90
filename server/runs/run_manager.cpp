#include "server/runs/run_manager.hpp"

#include <utility>

#include "server/estimators/estimator_factory.hpp"
#include "server/files/plain_name.hpp"
#include "server/record/comparison/compared_document.hpp"
#include "server/record/run_info.hpp"
#include "server/record/run_info_file.hpp"
#include "server/record/run_lock.hpp"
#include "server/record/run_manifest.hpp"
#include "server/runs/listed_run.hpp"
#include "server/runs/managed_runs.hpp"
#include "server/runs/run_removal.hpp"
#include "server/scenario/document/estimators/estimator_reach.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "server/timeline/run_timeline.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

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
  if (!fs::is_directory(options.scenarios_folder, failure)) {
    return Error{ErrorCode::kNotFound,
                 options.scenarios_folder.string() + ": no such folder of scenarios"};
  }
  remove_leftovers(options.runs_folder);
  std::unique_ptr<RunManager> manager(new RunManager());
  manager->impl_ = std::make_unique<ManagedRuns>(std::move(options));
  if (Status status = manager->impl_->start_threads(); !status) return status.error();
  return manager;
}

Result<RunInfo> RunManager::start(const std::string& scenario,
                                  const std::vector<Override>& overrides,
                                  const IdempotencyKey& key,
                                  StartReport* report) {
  StartReport unasked;
  StartReport& filled = report != nullptr ? *report : unasked;
  if (std::optional<Result<RunInfo>> earlier = impl_->started_by(key, filled)) return *earlier;
  Result<Scenario> loaded = impl_->library.load_to_fly(scenario, overrides);
  if (!loaded) return loaded.error();
  return start(std::move(*loaded), key, &filled);
}

Result<RunInfo> RunManager::start(Scenario scenario,
                                  const IdempotencyKey& key,
                                  StartReport* report) {
  StartReport unasked;
  if (Status status = check_start(scenario); !status) return status.error();
  return impl_->enqueue(std::move(scenario), key, report != nullptr ? *report : unasked);
}

Status RunManager::check_start(const Scenario& scenario) const {
  if (Status link = check_link(scenario, impl_->options.allowed_links); !link) return link;
  return check_native_parameters(scenario.estimators);
}

Status RunManager::check_memory(const Scenario& scenario) const {
  return impl_->check_memory(scenario);
}

std::shared_ptr<const void> RunManager::hold_memory(const RunMemory& memory) {
  return impl_->hold_memory(memory);
}

ScenarioLibrary& RunManager::library() { return impl_->library; }

Result<WorldExtent> RunManager::world_extent(const std::string& scenario,
                                             const std::function<bool()>& cancelled) {
  const Result<Scenario> loaded = impl_->library.load(scenario);
  if (!loaded) return loaded.error();
  if (world_must_be_made(*loaded)) {
    return Error{ErrorCode::kConflict, "the built-in world is made with its first flight"};
  }
  const auto opened = open_world(*loaded, [&](double) { return !cancelled || !cancelled(); });
  if (!opened) return opened.error();
  return extent_of((*opened)->world);
}

Result<std::shared_ptr<const OpenedWorld>> RunManager::open_world(
    const Scenario& scenario, const std::function<bool(double)>& progress) {
  return impl_->worlds.get(scenario, progress);
}

DataFolders RunManager::data_folders() const { return impl_->data_folders(); }

RunList RunManager::runs() const { return impl_->list(); }

Result<RunInfo> RunManager::run(const std::string& id) const {
  if (std::optional<RunInfo> known = impl_->known_info(id)) return *known;
  if (!is_plain_name(id) || !impl_->places.in_group(id)) return impl_->index.run(id);
  const Result<fs::path> place = folder(id);
  if (!place) return place.error();
  Result<RunInfo> info = read_listed_run(*place);
  if (info) info->id = id;
  return info;
}

Result<std::shared_ptr<RunTimeline>> RunManager::timeline(const std::string& id) {
  if (std::shared_ptr<RunTimeline> known = impl_->known_timeline(id)) return known;
  const Result<fs::path> place = folder(id);
  if (!place) return place.error();
  return impl_->shelved_timeline(id);
}

Status RunManager::cancel(const std::string& id) {
  if (impl_->cancel(id)) return {};
  if (const Result<fs::path> place = folder(id); !place && !impl_->known_timeline(id)) {
    return place.error();
  }
  return Error{ErrorCode::kConflict, "run \"" + id + "\" is neither queued nor running here"};
}

void RunManager::cancel_all() { impl_->cancel_all(); }

Status RunManager::remove(const std::string& id) {
  if (impl_->is_live(id)) {
    return Error{ErrorCode::kConflict, "run \"" + id + "\" has not ended: cancel it first"};
  }
  // A run cancelled while queued has no folder.
  if (impl_->forget_unflown(id)) return {};
  const Result<fs::path> place = folder(id);
  if (!place) return place.error();
  if (impl_->places.in_group(id)) {
    return Error{ErrorCode::kConflict, "run \"" + id + "\" belongs to a sweep or a study"};
  }
  if (Status status = remove_run_folder(*place); !status) return status;
  impl_->forget(id);
  return {};
}

Status RunManager::set_notes(const std::string& id, const RunNotes& notes) {
  if (Status status = check_notes(notes); !status) return status;
  if (impl_->is_live(id)) {
    return Error{ErrorCode::kConflict, "run \"" + id + "\" has not ended"};
  }
  const Result<fs::path> place = folder(id);
  if (!place) return place.error();
  if (RunLock::held(*place)) {
    return Error{ErrorCode::kConflict,
                 "run \"" + id + "\" has not ended: another process works on it"};
  }
  const std::lock_guard lock(impl_->writing_notes);
  return write_notes(*place, notes);
}

Result<nlohmann::json> RunManager::compared_document_of(const std::string& id) const {
  const Result<fs::path> place = folder(id);
  if (!place) return place.error();
  const Result<ReadManifest> manifest = read_run_manifest(*place, kMostListedBytes);
  if (!manifest) return manifest.error();
  // An invalid field has a default, which would be compared in its place.
  if (std::string problem = manifest->problem(); !problem.empty()) {
    return Error{ErrorCode::kUnreadable, std::move(problem)};
  }
  Result<nlohmann::json> scenario = document_of(id);
  if (!scenario) return scenario.error();
  return compared_document(manifest->values, std::move(*scenario));
}

Result<fs::path> RunManager::folder(const std::string& id) const {
  if (!is_plain_name(id)) return no_such_run(id);
  fs::path place = impl_->places.of(id);
  std::error_code ignored;
  if (!fs::exists(manifest_file(place), ignored)) return no_such_run(id);
  return place;
}

Result<nlohmann::json> RunManager::document_of(const std::string& id) const {
  if (std::optional<Scenario> scenario = impl_->active_scenario(id)) return scenario->resolved;
  const Result<fs::path> place = folder(id);
  if (!place) return place.error();
  Result<Scenario> flown = load_scenario(scenario_file(*place), {}, impl_->sources());
  if (!flown) return flown.error();
  return std::move(flown->resolved);
}

Result<Scenario> RunManager::scenario_of(const std::string& id) const {
  if (std::optional<Scenario> scenario = impl_->active_scenario(id)) return *scenario;
  const Result<fs::path> place = folder(id);
  if (!place) return place.error();
  Result<Scenario> flown = load_scenario(scenario_file(*place), {}, impl_->sources());
  if (!flown) return flown.error();
  flown->sources = impl_->sources();
  if (Status status = check_scenario(*flown); !status) return status.error();
  return flown;
}

Result<std::shared_ptr<const terrain::World>> RunManager::world_of(
    const std::string& id, const std::function<bool()>& cancelled) {
  if (const auto flown = impl_->flown_world(id)) return bare_world(flown);
  const Result<Scenario> scenario = scenario_of(id);
  if (!scenario) return scenario.error();
  const auto go_on = [&](double) { return !cancelled || !cancelled(); };
  const auto opened = impl_->worlds.get(*scenario, go_on);
  if (!opened) return opened.error();
  impl_->tell_world_change(id, **opened);
  return bare_world(*opened);
}

Result<std::shared_ptr<const OpenedWorld>> RunManager::ready_world_of(
    const std::string& id, const std::function<bool()>& cancelled) {
  const Result<Scenario> scenario = scenario_of(id);
  if (!scenario) return scenario.error();
  if (world_must_be_made(*scenario)) {
    return Error{ErrorCode::kNotFound, "the built-in world is not on this machine"};
  }
  return impl_->worlds.get(*scenario, [&](double) { return !cancelled || !cancelled(); });
}

const fs::path& RunManager::sweeps_folder() const { return impl_->options.sweeps_folder; }
const fs::path& RunManager::studies_folder() const { return impl_->options.studies_folder; }

PictureRate& RunManager::picture_rate() { return impl_->picture_rate; }

const RendererFactory& RunManager::renderer_factory() const {
  return impl_->options.renderer_factory;
}

}  // namespace overfly::server
