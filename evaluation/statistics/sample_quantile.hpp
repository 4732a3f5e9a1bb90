// Quantiles of a sample, interpolated.
#pragma once

#include <vector>

namespace overfly::evaluation {

/// The quantile at `share`, linear between the order statistics: type 7 of Hyndman and Fan 1996
/// (Am. Stat. 50, 361-365), the default of R and NumPy. The median of an even number of values is
/// the mean of the middle two.
/// @pre !values.empty(), all finite; share in [0, 1]
[[nodiscard]] double sample_quantile(std::vector<double> values, double share);

struct Quartiles {
  double low = 0.0;
  double median = 0.0;
  double high = 0.0;
};

/// @pre as sample_quantile
[[nodiscard]] Quartiles quartiles_of(const std::vector<double>& values);

}  // namespace overfly::evaluation
