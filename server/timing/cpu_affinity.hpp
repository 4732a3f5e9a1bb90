// Which processors a thread, and those that it starts, may run on.
#pragma once

#include <sched.h>
#include <vector>

#include "core/result.hpp"

namespace overfly::engine {

/// Binds the calling thread. `cpus` empty = leaves it as it is.
/// Errors: kInvalidArgument where none of them is a processor of this machine.
Status bind_thread(const std::vector<int>& cpus);

/// Puts the calling thread's processors back to what they were.
class AffinityGuard {
 public:
  AffinityGuard();
  ~AffinityGuard();
  AffinityGuard(const AffinityGuard&) = delete;
  AffinityGuard& operator=(const AffinityGuard&) = delete;

 private:
  cpu_set_t before_{};
  bool known_ = false;
};

/// Largest resident memory of this process so far [MB].
[[nodiscard]] double own_peak_memory_mb();

}  // namespace overfly::engine
