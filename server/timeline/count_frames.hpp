// Binary search in the rows of a timeline.
#pragma once

#include <cstddef>

#include "server/timeline/run_timeline.hpp"

namespace overfly::server {

/// Number of the first rows, of `rows`, for which `before` holds.
/// @param before  a predicate of a row's number. @pre it holds for the first rows only
template <typename Before>
[[nodiscard]] std::size_t count_rows(std::size_t rows, const Before& before) {
  std::size_t low = 0;
  std::size_t high = rows;
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    if (before(middle)) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

/// Number of recorded frames of a camera for which `before` holds.
/// @param before  a predicate of a FrameRow. @pre it holds for the first frames only
template <typename Before>
[[nodiscard]] std::size_t count_frames(const RunTimeline& timeline,
                                       std::size_t camera,
                                       const Before& before) {
  return count_rows(timeline.frame_count(camera), [&](std::size_t i) {
    const auto row = timeline.frames(i, 1, camera);
    return !row.empty() && before(row.front());
  });
}

}  // namespace overfly::server
