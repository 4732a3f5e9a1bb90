// Workers that a scheduler starts.
#pragma once

#include <cstddef>

#include "core/result.hpp"
#include "server/runs/run_memory.hpp"

namespace overfly::server::experiments {

/// Flights of a job folder.
struct FlightCounts {
  std::size_t open = 0;       ///< not over
  std::size_t untaken = 0;    ///< of these, those that no worker has taken
  std::size_t delivered = 0;  ///< by workers so far
};

class WorkerSupply {
 public:
  WorkerSupply() = default;
  virtual ~WorkerSupply() = default;
  WorkerSupply(const WorkerSupply&) = delete;
  WorkerSupply& operator=(const WorkerSupply&) = delete;

  /// Starts workers that are missing. Called about twice a second.
  /// @param memory  the most that one of the flights needs
  /// Errors: if workers cannot be had at all.
  virtual Status keep(const FlightCounts& flights, const RunMemory& memory) = 0;
  /// Ends the workers.
  virtual void stop() = 0;
};

}  // namespace overfly::server::experiments
