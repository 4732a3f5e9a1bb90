#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/outside/source_policy.hpp"
#include "server/camera/renderer_factory.hpp"

namespace overfly::server {

struct RunManagerOptions {
  std::filesystem::path runs_folder;  ///< created if absent
  std::filesystem::path scenarios_folder;
  /// Where scenarios of clients are kept, created with the first one; empty = none are. Other
  /// folders that they name do not become data folders.
  std::filesystem::path saved_scenarios_folder;
  /// Folders of sweeps, whose runs are shown under the ids SWEEP.RUN; empty = none are.
  std::filesystem::path sweeps_folder;
  /// Folders of studies, whose runs are shown under the ids STUDY.RUN; empty = none are made.
  std::filesystem::path studies_folder;
  RendererFactory renderer_factory;
  int max_parallel_runs = 1;           ///< further runs wait in a queue
  std::size_t max_waiting_runs = 100;  ///< further runs are refused
  /// Memory for flights and for pictures for viewers; 0 = most of the machine's.
  std::uint64_t memory_limit_bytes = 0;
  /// Overrides may name programs to start and network addresses.
  bool allow_commands = false;
  /// Links to live vehicles that may be opened, as LinkAddress::text.
  std::vector<std::string> allowed_links;
  /// Folders whose files scenarios may name, in addition to `declared_folders(scenarios_folder)`;
  /// never the folders of runs, sweeps and studies. Without a value any regular file may be named.
  std::optional<std::vector<std::filesystem::path>> data_folders;
  /// Logs flights that fail: (level, text). Called from several threads; may be empty.
  std::function<void(const std::string&, const std::string&)> log;
};

/// Folders whose files scenarios may name, and which files of the machine these are.
struct DataFolders {
  std::vector<std::filesystem::path> folders;
  std::vector<std::filesystem::path> closed;  ///< in them, but may not be named
  SourcePolicy sources;
};

/// The result of a request for a run, in addition to its error.
struct StartReport {
  bool repeated = false;  ///< the idempotency key matched an earlier run
  /// Why a valid scenario is not flown now.
  enum class Refusal { kNone, kQueueFull, kMemory, kKeyUsed } refusal = Refusal::kNone;
};

}  // namespace overfly::server
