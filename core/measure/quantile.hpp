// Quantiles of measured values.
#pragma once

#include <vector>

namespace overfly {

/// The smallest value that at least `share` of the values do not exceed (nearest rank); 0 if there
/// are none.
/// @param share  in (0, 1]
[[nodiscard]] double quantile(std::vector<double> values, double share);

}  // namespace overfly
