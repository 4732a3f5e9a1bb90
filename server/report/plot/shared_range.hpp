// The values that a plot's axis encloses: not those of estimates that have diverged, next to which
// all other lines would be one.
#pragma once

#include <string>
#include <vector>

#include "server/report/plot/series.hpp"

namespace overfly::server::plot {

struct SharedRange {
  Range range;                      ///< low > high without points
  std::vector<std::string> beyond;  ///< labels of the lines that are left out, the smaller first
};

/// The values of all lines without the estimates that have diverged: 100 times as large as those of
/// all others together next to a truth, 10 000 times in plots of errors. If nothing else is shown,
/// such an estimate is shown whole. The dashboard has the same rule.
/// @param least  smaller ranges count as this large
[[nodiscard]] SharedRange shared_y_range(const std::vector<Series>& series, double least);

}  // namespace overfly::server::plot
