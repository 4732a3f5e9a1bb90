// Cancellation of long operations.
#pragma once

#include <atomic>

namespace overfly {

/// @param cancel  set to true by the caller to cancel; null if the operation cannot be cancelled
[[nodiscard]] inline bool is_cancelled(const std::atomic<bool>* cancel) {
  return cancel != nullptr && cancel->load();
}

}  // namespace overfly
