// Flights as processes of their own, so that one that crashes or runs out of memory ends no other.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace overfly::server::experiments {

/// One flight to be flown.
struct FlightJob {
  std::string id;
  std::filesystem::path scenario;  ///< its file
  std::filesystem::path folder;    ///< run folder to be created
  std::filesystem::path output;    ///< file for what the process prints
  double timeout_s = 0.0;
};

/// A process that has ended.
struct EndedFlight {
  std::string id;
  double duration_s = 0.0;
  bool timed_out = false;
  std::string reason;  ///< "exit code 1", "signal 9 (Killed)"; empty for exit code 0
};

/// Must be used by one thread, the one that starts the processes: they are killed with it.
class FlightProcesses {
 public:
  /// @param program  runs `PROGRAM run SCENARIO --out FOLDER --quiet`
  explicit FlightProcesses(std::filesystem::path program) : program_(std::move(program)) {}
  ~FlightProcesses();  ///< kills
  FlightProcesses(const FlightProcesses&) = delete;
  FlightProcesses& operator=(const FlightProcesses&) = delete;

  /// Errors: kIo, kInternal with the system's reason.
  Status start(const FlightJob& job);
  [[nodiscard]] std::size_t running() const { return children_.size(); }
  /// A process that has ended, or was killed because of its time limit. Does not wait.
  [[nodiscard]] std::optional<EndedFlight> ended();
  /// Asks all to stop (SIGTERM), waits up to ten seconds, then kills.
  void stop();

 private:
  struct Child {
    pid_t pid = -1;
    FlightJob job;
    std::chrono::steady_clock::time_point started;
    bool timed_out = false;
  };

  std::filesystem::path program_;
  std::vector<Child> children_;
};

}  // namespace overfly::server::experiments
