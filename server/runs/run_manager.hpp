// The runs of a server: those on disk and those in progress.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/record/run_info.hpp"
#include "server/runs/idempotency_keys.hpp"
#include "server/runs/run_index.hpp"
#include "server/runs/run_manager_options.hpp"
#include "server/runs/run_memory.hpp"
#include "server/runs/run_notes.hpp"
#include "server/runs/scenario_library.hpp"
#include "server/timeline/run_timeline.hpp"
#include "server/timing/picture_rate.hpp"
#include "server/worlds/world_extent.hpp"
#include "terrain/world.hpp"

namespace overfly::server {

class ManagedRuns;
struct OpenedWorld;

/// Thread-safe. Owns the threads of the runs; its destructor cancels and joins them.
class RunManager {
 public:
  /// Errors: kInvalidArgument for an option; kNotFound, kIo for a folder; kInternal if no thread
  /// can be started.
  static Result<std::unique_ptr<RunManager>> create(RunManagerOptions options);
  ~RunManager();

  [[nodiscard]] ScenarioLibrary& library();

  /// Where a scenario's world lies. Opens it; does not make the built-in one.
  /// @param cancelled  polled while the world is opened; true cancels
  /// Errors: kNotFound; kConflict if the built-in world was not made yet; as load_scenario,
  /// check_scenario, open_scenario_world.
  [[nodiscard]] Result<WorldExtent> world_extent(const std::string& scenario,
                                                 const std::function<bool()>& cancelled = {});
  /// The world of a scenario, shared with runs and views; makes the built-in one if this machine
  /// does not have it.
  /// @param progress  as of open_scenario_world
  /// Errors: as open_scenario_world.
  [[nodiscard]] Result<std::shared_ptr<const OpenedWorld>> open_world(
      const Scenario& scenario, const std::function<bool(double)>& progress = {});
  /// What scenarios may name now.
  [[nodiscard]] DataFolders data_folders() const;

  /// Starts (or queues) a run of a scenario with overrides. The same idempotency key returns the
  /// same run for a day.
  /// Errors: kNotFound; kInvalidArgument with the invalid fields; kConflict if the queue is full,
  /// if the key belongs to another request, or after cancel_all; kUnsupported if it needs more
  /// memory than there is.
  [[nodiscard]] Result<RunInfo> start(const std::string& scenario,
                                      const std::vector<Override>& overrides,
                                      const IdempotencyKey& key = {},
                                      StartReport* report = nullptr);
  /// The same for a scenario that was read already, as by ScenarioLibrary::read.
  [[nodiscard]] Result<RunInfo> start(Scenario scenario,
                                      const IdempotencyKey& key = {},
                                      StartReport* report = nullptr);
  /// Whether the server may open the link of a live flight, and whether the parameters of native
  /// estimators are in order. Errors: as server::check_link and check_native_parameters.
  [[nodiscard]] Status check_start(const Scenario& scenario) const;
  /// Whether a flight fits in the server's memory if it is the only one.
  /// Errors: as MemoryBudget::check.
  [[nodiscard]] Status check_memory(const Scenario& scenario) const;
  /// Reserves memory for a flight in another process, in addition to the runs, as long as the
  /// result lives. Null while there is not enough, or while a run waits for memory. @pre
  /// check_memory was ok
  [[nodiscard]] std::shared_ptr<const void> hold_memory(const RunMemory& memory);
  /// Newest first. Answers from memory; reads only folders that have changed.
  [[nodiscard]] RunList runs() const;
  /// One run. Errors: kNotFound.
  [[nodiscard]] Result<RunInfo> run(const std::string& id) const;
  /// The timeline, live or read from disk (cached). Errors: kNotFound, kUnreadable.
  [[nodiscard]] Result<std::shared_ptr<RunTimeline>> timeline(const std::string& id);
  /// Errors: kNotFound; kConflict if it is not running or queued.
  Status cancel(const std::string& id);
  /// Cancels the runs that fly and starts no more: those in the queue stay there. Returns at once;
  /// the destructor waits for their ends.
  void cancel_all();
  /// Deletes the folder. If several threads call it at the same time, one succeeds.
  /// Errors: kNotFound; kConflict while it runs, while another process uses it, and for a run of a
  /// sweep or a study.
  Status remove(const std::string& id);
  /// Replaces what people wrote about a run.
  /// Errors: as write_notes; kNotFound; kConflict before the run has ended.
  Status set_notes(const std::string& id, const RunNotes& notes);
  /// What a run is compared by with others, as compared_document.
  /// Errors: kNotFound; as read_run_manifest, document_of; kUnreadable naming an invalid field.
  [[nodiscard]] Result<nlohmann::json> compared_document_of(const std::string& id) const;
  /// Folder of a run. Errors: kNotFound, also for an id that is not a plain folder name.
  [[nodiscard]] Result<std::filesystem::path> folder(const std::string& id) const;
  /// The resolved document of a run's scenario. Errors: kNotFound; as load_scenario.
  [[nodiscard]] Result<nlohmann::json> document_of(const std::string& id) const;
  /// The scenario of a run. Errors: kNotFound; as load_scenario, check_scenario.
  [[nodiscard]] Result<Scenario> scenario_of(const std::string& id) const;
  /// The world of a run: the one it is flying over, or else the world of its scenario opened from
  /// the current files. Shared with runs and views.
  /// @param cancelled  polled while the world is opened; true cancels
  /// Errors: kNotFound; as open_scenario_world.
  [[nodiscard]] Result<std::shared_ptr<const terrain::World>> world_of(
      const std::string& id, const std::function<bool()>& cancelled = {});
  /// The same with its source files, if nothing has to be made for it.
  /// Errors: as world_of; kNotFound if the built-in world is not on this machine.
  [[nodiscard]] Result<std::shared_ptr<const OpenedWorld>> ready_world_of(
      const std::string& id, const std::function<bool()>& cancelled = {});
  /// RunManagerOptions::sweeps_folder
  [[nodiscard]] const std::filesystem::path& sweeps_folder() const;
  /// RunManagerOptions::studies_folder
  [[nodiscard]] const std::filesystem::path& studies_folder() const;
  [[nodiscard]] const RendererFactory& renderer_factory() const;
  /// Rate limit of pictures for viewers during flights.
  [[nodiscard]] PictureRate& picture_rate();

 private:
  RunManager();
  std::unique_ptr<ManagedRuns> impl_;
};

}  // namespace overfly::server
