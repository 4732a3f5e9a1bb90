// Waiting times between attempts.
#pragma once

#include <algorithm>
#include <chrono>

namespace overfly::flight::mavlink {

/// 0.5 s after the first failure, then twice as long each time, up to 8 s.
class BackOff {
 public:
  [[nodiscard]] std::chrono::milliseconds next() {
    const std::chrono::milliseconds wait = next_;
    next_ = std::min(2 * next_, std::chrono::milliseconds(8000));
    return wait;
  }
  void reset() { next_ = kFirst; }

 private:
  static constexpr std::chrono::milliseconds kFirst{500};
  std::chrono::milliseconds next_ = kFirst;
};

}  // namespace overfly::flight::mavlink
