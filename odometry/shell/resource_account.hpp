// What an estimator uses of the machine, for `VoPort::resource_use`.
#pragma once

#include <algorithm>
#include <atomic>

namespace overfly::odometry {

/// Totals since the estimator was created. One thread writes, others may read.
class ResourceAccount {
 public:
  void add_cpu_s(double cpu_s) { cpu_s_ = cpu_s_ + cpu_s; }
  void note_memory_mb(double memory_mb) {
    peak_memory_mb_ = std::max<double>(peak_memory_mb_, memory_mb);
  }
  [[nodiscard]] double cpu_s() const { return cpu_s_; }
  [[nodiscard]] double peak_memory_mb() const { return peak_memory_mb_; }

 private:
  std::atomic<double> cpu_s_{0.0};
  std::atomic<double> peak_memory_mb_{0.0};
};

}  // namespace overfly::odometry
