// Stamped lines of a file, put in order of time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace overfly {

/// A line of a file and its time.
struct TimedLine {
  std::int64_t t_ns = 0;
  int line = 0;  ///< number in the file, from 1
};

/// Which lines are kept, in which order.
struct TimeOrder {
  std::vector<std::size_t> kept;  ///< indices, times strictly increasing
  /// What was left out or moved, with file, count and first line; empty where nothing was.
  std::vector<std::string> warnings;
};

/// Sorts by time. Of lines with the same time the first in the file is kept: evo (Grupp 2017) looks
/// for the nearest stamp with argmin, which takes the first of equal ones.
/// @param what  one line's content in the plural, for the warnings: "poses"
[[nodiscard]] TimeOrder order_by_time(const std::string& file,
                                      const std::string& what,
                                      const std::vector<TimedLine>& lines);

}  // namespace overfly
