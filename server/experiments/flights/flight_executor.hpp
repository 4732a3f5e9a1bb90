// Where flights are flown: by processes of this machine, or by workers elsewhere.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/runs/run_memory.hpp"

namespace overfly::server::experiments {

/// One flight to be flown.
struct FlightJob {
  std::string id;
  std::filesystem::path scenario;  ///< its file
  std::filesystem::path folder;    ///< run folder to be created
  std::filesystem::path output;    ///< file for what the process prints
  double timeout_s = 0.0;
  RunMemory memory;
  std::vector<std::string> options{};  ///< further ones of `overfly run`, on this machine only
};

/// A flight that has ended.
struct EndedFlight {
  std::string id;
  double duration_s = 0.0;
  bool timed_out = false;
  std::string reason;  ///< "exit code 1", "signal 9 (Killed)"; empty for exit code 0
};

class FlightExecutor {
 public:
  FlightExecutor() = default;
  virtual ~FlightExecutor() = default;
  FlightExecutor(const FlightExecutor&) = delete;
  FlightExecutor& operator=(const FlightExecutor&) = delete;

  /// Errors: kIo, kInternal with the system's reason.
  virtual Status start(const FlightJob& job) = 0;
  /// Flights that were started and have not been returned by ended().
  [[nodiscard]] virtual std::size_t running() const = 0;
  /// Of these the flights that a process flies now; the others wait for a worker.
  [[nodiscard]] virtual std::size_t flying() const = 0;
  /// A flight that has ended. Does not wait.
  /// Errors: if no flight can be flown any more.
  [[nodiscard]] virtual Result<std::optional<EndedFlight>> ended() = 0;
  /// Ends all flights.
  virtual void stop() = 0;
};

}  // namespace overfly::server::experiments
