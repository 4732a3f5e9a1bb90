// Collects log lines until they are taken.
#pragma once

#include <cstddef>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace overfly::ros1 {

/// Thread-safe.
class LineLog {
 public:
  void add(std::string line) {
    const std::lock_guard lock(mutex_);
    if (lines_.size() < kMost) {
      lines_.push_back(std::move(line));
    } else {
      ++lost_;
    }
  }

  [[nodiscard]] std::vector<std::string> take() {
    const std::lock_guard lock(mutex_);
    if (lost_ > 0) lines_.push_back(std::to_string(std::exchange(lost_, 0)) + " lines were lost");
    return std::exchange(lines_, {});
  }

 private:
  static constexpr std::size_t kMost = 1000;
  std::mutex mutex_;
  std::vector<std::string> lines_;
  std::size_t lost_ = 0;
};

}  // namespace overfly::ros1
