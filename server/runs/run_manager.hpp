// The runs of a server: those on disk and those in flight.
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
#include "server/record/run_timeline.hpp"
#include "server/runs/run_index.hpp"
#include "server/runs/run_manager_options.hpp"
#include "server/scenario/document/scenario_list.hpp"
#include "server/timing/picture_rate.hpp"
#include "terrain/world.hpp"

namespace overfly::engine {

class ManagedRuns;

/// Thread-safe. Owns the threads of the runs; its destructor cancels and joins them.
class RunManager {
 public:
  /// Errors: kInvalidArgument for an option; kNotFound, kIo for a folder; kInternal when no thread
  /// can be started.
  static Result<std::unique_ptr<RunManager>> create(RunManagerOptions options);
  ~RunManager();

  [[nodiscard]] std::vector<ScenarioEntry> scenarios() const;
  /// The resolved document. Errors: kNotFound, kInvalidArgument.
  [[nodiscard]] Result<nlohmann::json> scenario(const std::string& name) const;

  /// Starts (or queues) a run of a scenario with overrides. The same idempotency key gives the
  /// run that it gave before, within a day. Errors: kNotFound, kInvalidArgument with the faulty
  /// fields; kConflict with a full queue; kUnsupported where it needs more memory than there is.
  [[nodiscard]] Result<RunInfo> start(const std::string& scenario,
                                      const std::vector<Override>& overrides,
                                      const std::string& idempotency_key = "",
                                      StartReport* report = nullptr);
  /// Whether a client that is not trusted with this machine may ask for these overrides: they must
  /// leave commands, sockets and addresses of estimators as the scenario's file has them.
  /// Errors: kInvalidArgument naming the field. Other faults are left to start().
  [[nodiscard]] Status check_overrides(const std::string& scenario,
                                       const std::vector<Override>& overrides) const;
  /// Newest first. From memory: only folders that have changed are read.
  [[nodiscard]] RunList runs() const;
  /// One run alone. Errors: kNotFound.
  [[nodiscard]] Result<RunInfo> run(const std::string& id) const;
  /// The time line, live or read from disk (cached). Errors: kNotFound, kUnreadable.
  [[nodiscard]] Result<std::shared_ptr<RunTimeline>> timeline(const std::string& id);
  /// Errors: kNotFound; kConflict when it is not running or queued.
  Status cancel(const std::string& id);
  /// Deletes the folder. Of several calls at a time one succeeds. Errors: kNotFound; kConflict
  /// while it runs, and while another process is at work in it.
  Status remove(const std::string& id);
  /// Folder of a run. Errors: kNotFound, also for an id that is no plain folder name.
  [[nodiscard]] Result<std::filesystem::path> folder(const std::string& id) const;
  /// The scenario that a run flies or flew. Errors: kNotFound; as load_scenario, check_scenario.
  [[nodiscard]] Result<Scenario> scenario_of(const std::string& id) const;
  /// The world that a run flies over, or that of the run's scenario as its files are now. Shared
  /// with runs and views.
  /// @param cancelled  asked now and then while it is opened; true ends that
  /// Errors: kNotFound; as open_scenario_world.
  [[nodiscard]] Result<std::shared_ptr<const terrain::World>> world_of(
      const std::string& id, const std::function<bool()>& cancelled = {});
  [[nodiscard]] const RendererFactory& renderer_factory() const;
  /// Of pictures for viewers, beside the flights.
  [[nodiscard]] PictureRate& picture_rate();

 private:
  RunManager();
  std::unique_ptr<ManagedRuns> impl_;
};

}  // namespace overfly::engine
