// The runs of a server: those on disk and those in flight.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/engine/picture_rate.hpp"
#include "server/engine/run.hpp"

namespace overfly::engine {

struct ScenarioEntry {
  std::string name;  ///< file name without .json
  std::filesystem::path file;
  std::string title;
  std::string description;
  std::string error;  ///< why it cannot be flown here; empty when it can
};

struct RunManagerOptions {
  std::filesystem::path runs_folder;  ///< made if absent
  std::filesystem::path scenarios_folder;
  RendererFactory renderer_factory;
  int max_parallel_runs = 1;  ///< further ones wait in a queue
  /// Overrides may name programs to start and addresses to speak to.
  bool allow_commands = false;
  /// Folders whose files scenarios may name, besides `declared_folders(scenarios_folder)`; never
  /// the runs' own. Without a value any regular file may be named.
  std::optional<std::vector<std::filesystem::path>> data_folders;
};

/// Thread-safe. Owns the threads of the runs; its destructor cancels and joins them.
class RunManager {
 public:
  static Result<std::unique_ptr<RunManager>> create(RunManagerOptions options);
  ~RunManager();

  [[nodiscard]] std::vector<ScenarioEntry> scenarios() const;
  /// The resolved document. Errors: kNotFound, kInvalidArgument.
  [[nodiscard]] Result<nlohmann::json> scenario(const std::string& name) const;

  /// Starts (or queues) a run of a scenario with overrides. The same idempotency key gives the
  /// run that it gave before. Errors: kNotFound, kInvalidArgument with the faulty fields.
  [[nodiscard]] Result<RunInfo> start(const std::string& scenario,
                                      const std::vector<Override>& overrides,
                                      const std::string& idempotency_key = "");
  /// Whether a client that is not trusted with this machine may ask for these overrides: they must
  /// leave commands, sockets and addresses of estimators as the scenario's file has them.
  /// Errors: kInvalidArgument naming the field. Other faults are left to start().
  [[nodiscard]] Status check_overrides(const std::string& scenario,
                                       const std::vector<Override>& overrides) const;
  /// Newest first.
  [[nodiscard]] std::vector<RunInfo> runs() const;
  /// The time line, live or read from disk (cached). Errors: kNotFound, kUnreadable.
  [[nodiscard]] Result<std::shared_ptr<RunTimeline>> timeline(const std::string& id);
  /// Errors: kNotFound; kConflict when it is not running or queued.
  Status cancel(const std::string& id);
  /// Deletes the folder. Errors: kNotFound; kConflict while it runs.
  Status remove(const std::string& id);
  /// Folder of a run. Errors: kNotFound, also for an id that is no plain folder name.
  [[nodiscard]] Result<std::filesystem::path> folder(const std::string& id) const;
  /// The scenario that a run flies or flew. Errors: kNotFound; as load_scenario, check_scenario.
  [[nodiscard]] Result<Scenario> scenario_of(const std::string& id) const;
  /// The world that a run flies over, or that of the run's scenario as its files are now. Shared
  /// with runs and views. Errors: kNotFound; as open_scenario_world.
  [[nodiscard]] Result<std::shared_ptr<const terrain::World>> world_of(const std::string& id);
  [[nodiscard]] const RendererFactory& renderer_factory() const;
  /// Of pictures for viewers, beside the flights.
  [[nodiscard]] PictureRate& picture_rate();

 private:
  RunManager();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace overfly::engine
