// Measures the time of upstream calls. C++11 (see upstream_system.hpp).
#pragma once

#include <ctime>

namespace overfly_adapters {

/// Wall time and CPU time. Only CPU time is comparable on a busy machine.
class Stopwatch {
 public:
  double wall_ms() const { return now_ms(CLOCK_MONOTONIC) - wall_start_ms_; }
  double thread_cpu_ms() const { return now_ms(CLOCK_THREAD_CPUTIME_ID) - thread_start_ms_; }
  /// CPU time of all threads of this process.
  double process_cpu_ms() const { return now_ms(CLOCK_PROCESS_CPUTIME_ID) - process_start_ms_; }

 private:
  static double now_ms(clockid_t clock) {
    timespec now{};
    ::clock_gettime(clock, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
  }

  double wall_start_ms_ = now_ms(CLOCK_MONOTONIC);
  double thread_start_ms_ = now_ms(CLOCK_THREAD_CPUTIME_ID);
  double process_start_ms_ = now_ms(CLOCK_PROCESS_CPUTIME_ID);
};

}  // namespace overfly_adapters
