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
#include "server/experiments/flights/flight_executor.hpp"

namespace overfly::server::experiments {

/// Must be used by one thread, the one that starts the processes: they are killed with it.
class FlightProcesses : public FlightExecutor {
 public:
  /// @param program  runs `PROGRAM run SCENARIO --out FOLDER --quiet OPTIONS...`
  /// @param options  further ones of `overfly run`
  explicit FlightProcesses(std::filesystem::path program, std::vector<std::string> options = {})
      : program_(std::move(program)), options_(std::move(options)) {}
  ~FlightProcesses() override;  ///< kills

  Status start(const FlightJob& job) override;
  [[nodiscard]] std::size_t running() const override { return children_.size(); }
  [[nodiscard]] std::size_t flying() const override { return children_.size(); }
  /// A process that has ended. At its time limit it is asked to (SIGTERM), and killed ten seconds
  /// later. Never an error.
  [[nodiscard]] Result<std::optional<EndedFlight>> ended() override;
  /// Asks all to stop (SIGTERM), waits up to ten seconds, then kills.
  void stop() override;
  /// Kills one, which then is not returned by ended().
  void kill(const std::string& id);

 private:
  struct Child {
    pid_t pid = -1;
    FlightJob job;
    std::chrono::steady_clock::time_point started;
    std::optional<std::chrono::steady_clock::time_point> timed_out;  ///< when it was asked to end
  };

  std::filesystem::path program_;
  std::vector<std::string> options_;
  std::vector<Child> children_;
};

}  // namespace overfly::server::experiments
