// Processor time of a thread and of the process.
#pragma once

#include <ctime>

namespace overfly {

/// Processor time on a CPU clock of the system [s].
[[nodiscard]] inline double cpu_clock_s(clockid_t clock) {
  timespec used{};
  clock_gettime(clock, &used);
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

/// Processor time of the calling thread [s].
[[nodiscard]] inline double thread_cpu_s() { return cpu_clock_s(CLOCK_THREAD_CPUTIME_ID); }

/// Processor time of all threads of this process [s].
[[nodiscard]] inline double process_cpu_s() { return cpu_clock_s(CLOCK_PROCESS_CPUTIME_ID); }

}  // namespace overfly
