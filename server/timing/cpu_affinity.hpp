// The processors that a thread and its child threads may run on.
#pragma once

#include <sched.h>
#include <vector>

#include "core/result.hpp"

namespace overfly::server {

/// Binds the calling thread. Does nothing if `cpus` is empty.
/// Errors: kInvalidArgument if none of them is a processor of this machine.
Status bind_thread(const std::vector<int>& cpus);

/// Restores the processor affinity of the calling thread.
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

}  // namespace overfly::server
