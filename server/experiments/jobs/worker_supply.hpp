// Workers that a scheduler starts.
#pragma once

#include <cstddef>

#include "core/result.hpp"
#include "server/runs/run_memory.hpp"

namespace overfly::server::experiments {

class WorkerSupply {
 public:
  WorkerSupply() = default;
  virtual ~WorkerSupply() = default;
  WorkerSupply(const WorkerSupply&) = delete;
  WorkerSupply& operator=(const WorkerSupply&) = delete;

  /// Starts workers that are missing. Called about twice a second.
  /// @param open  flights that are not over
  /// @param delivered  flights that workers have delivered so far
  /// @param memory  the most that one of the flights needs
  /// Errors: if workers cannot be had at all.
  virtual Status keep(std::size_t open, std::size_t delivered, const RunMemory& memory) = 0;
  /// Ends the workers.
  virtual void stop() = 0;
};

}  // namespace overfly::server::experiments
