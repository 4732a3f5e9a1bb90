// Messages of an estimator to the user.
#pragma once

#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace overfly::odometry {

/// Thread-safe: one thread tracks and adds lines, another takes them.
class EstimatorLog {
 public:
  void add(std::string line) {
    const std::lock_guard lock(mutex_);
    lines_.push_back(std::move(line));
  }
  /// Returns the lines since the last call.
  [[nodiscard]] std::vector<std::string> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(lines_, {});
  }

 private:
  std::mutex mutex_;
  std::vector<std::string> lines_;
};

}  // namespace overfly::odometry
