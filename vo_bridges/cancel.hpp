// Waiting for another program, unless the caller cancels.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <string>
#include <utility>

#include "core/cancel.hpp"
#include "core/result.hpp"

namespace overfly {

/// A wait looks at the wish that often: the doors promise 50 ms.
inline constexpr std::chrono::milliseconds kCancelPeriod{20};
/// What an answer under way has from the wish on: an estimator that works is not cut off in a
/// frame.
inline constexpr std::chrono::milliseconds kCancelPatience{1000};

[[nodiscard]] inline Error cancelled(const std::string& wait) {
  return {ErrorCode::kCancelled, "stopped while waiting for " + wait};
}

/// Waits by `wait(timeout)`, again and again, until it gives something, `end`, or the wish to stop
/// and `patience` after it.
/// @return what it gave last
template <typename Wait>
[[nodiscard]] auto wait_unless_cancelled(const std::atomic<bool>* cancel,
                                         std::chrono::steady_clock::time_point end,
                                         const Wait& wait,
                                         std::chrono::milliseconds patience = {}) {
  using std::chrono::nanoseconds;
  bool noticed = false;
  for (;;) {
    if (is_cancelled(cancel) && !std::exchange(noticed, true)) {
      end = std::min(end, std::chrono::steady_clock::now() + patience);
    }
    const nanoseconds left =
        std::max<nanoseconds>(end - std::chrono::steady_clock::now(), nanoseconds(0));
    const bool last = cancel == nullptr || left <= kCancelPeriod;
    auto got = wait(last ? left : nanoseconds(kCancelPeriod));
    if (got || last) return got;
  }
}

}  // namespace overfly
