// Sorts the stamped lines of a file by time.
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

/// The kept lines in time order.
struct TimeOrder {
  std::vector<std::size_t> kept;  ///< indices, times strictly increasing
  /// Which lines were dropped or moved: file, count and first line. Empty if none.
  std::vector<std::string> warnings;
};

/// Sorts lines by time and keeps the first of several with the same time. This matches evo (Grupp
/// 2017), which finds the nearest stamp with argmin, and argmin returns the first of equal values.
/// @param what  content of the lines in the plural, for the warnings: "poses"
[[nodiscard]] TimeOrder order_by_time(const std::string& file,
                                      const std::string& what,
                                      const std::vector<TimedLine>& lines);

}  // namespace overfly
