// Processor time of a thread.
#pragma once

#include <ctime>

namespace overfly {

/// Processor time of the calling thread [s].
[[nodiscard]] inline double thread_cpu_s() {
  timespec used{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

}  // namespace overfly
