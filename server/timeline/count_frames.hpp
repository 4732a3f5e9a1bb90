// Binary search in the frames of a timeline.
#pragma once

#include <cstddef>

#include "server/timeline/run_timeline.hpp"

namespace overfly::server {

/// Number of recorded frames of a camera for which `before` holds.
/// @param before  a predicate of a FrameRow. @pre it holds for the first frames only
template <typename Before>
[[nodiscard]] std::size_t count_frames(const RunTimeline& timeline,
                                       std::size_t camera,
                                       const Before& before) {
  std::size_t low = 0;
  std::size_t high = timeline.frame_count(camera);
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    const auto row = timeline.frames(middle, 1, camera);
    if (!row.empty() && before(row.front())) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

}  // namespace overfly::server
