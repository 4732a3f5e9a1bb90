// The wish to stop, looked at by long work.
#pragma once

#include <atomic>

namespace overfly {

/// @param cancel  may be null: nobody will ask
[[nodiscard]] inline bool is_cancelled(const std::atomic<bool>* cancel) {
  return cancel != nullptr && cancel->load();
}

}  // namespace overfly
