// Cancellable waiting for another program.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <string>
#include <utility>

#include "core/cancel.hpp"
#include "core/result.hpp"

namespace overfly {

/// Interval at which a wait checks for cancellation: every wait ends within 50 ms of it.
inline constexpr std::chrono::milliseconds kCancelPeriod{20};
/// Time that a pending answer gets after a cancellation, so that the other program is not
/// interrupted while it works on the answer.
inline constexpr std::chrono::milliseconds kCancelPatience{1000};

[[nodiscard]] inline Error cancelled(const std::string& wait) {
  return {ErrorCode::kCancelled, "stopped while waiting for " + wait};
}

/// Calls `wait(timeout)` repeatedly until it returns a value, `end` is reached, or `patience` has
/// passed after a cancellation.
/// @return the last value of `wait`
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
