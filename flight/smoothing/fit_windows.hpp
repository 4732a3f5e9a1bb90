// Divides the control points of a long spline into windows that are solved one after another.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace overfly::flight::smoothing {

/// Control points [first, end) are solved for; those of [keep_first, keep_end) are kept, the others
/// only give the kept ones neighbours. Kept ranges cover all control points once.
struct FitWindow {
  std::size_t first = 0;
  std::size_t end = 0;
  std::size_t keep_first = 0;
  std::size_t keep_end = 0;
};

/// The influence of a sample fades within a few time constants of the smoothing (below 1 s), so an
/// overlap of several seconds makes windows equal to one solution of the whole spline.
[[nodiscard]] inline std::vector<FitWindow> fit_windows(std::size_t control_points,
                                                        std::size_t kept,
                                                        std::size_t overlap) {
  std::vector<FitWindow> windows;
  for (std::size_t begin = 0; begin < control_points; begin += kept) {
    FitWindow window;
    window.keep_first = begin;
    window.keep_end = std::min(begin + kept, control_points);
    window.first = begin - std::min(begin, overlap);
    window.end = std::min(window.keep_end + overlap, control_points);
    windows.push_back(window);
  }
  return windows;
}

}  // namespace overfly::flight::smoothing
