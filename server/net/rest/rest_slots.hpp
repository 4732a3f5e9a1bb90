// Places for requests that take a reading thread for long, which other viewers need too.
#pragma once

#include <atomic>
#include <memory>

namespace overfly::net {

/// One of `most` places, free again when the last copy of it is gone; null if all are taken.
[[nodiscard]] inline std::shared_ptr<const void> take_slot(
    const std::shared_ptr<std::atomic<int>>& taken, int most) {
  if (taken->fetch_add(1) >= most) {
    taken->fetch_sub(1);
    return nullptr;
  }
  return {taken.get(), [taken](const void*) { taken->fetch_sub(1); }};
}

}  // namespace overfly::net
