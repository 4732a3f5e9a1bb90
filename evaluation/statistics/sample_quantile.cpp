#include "evaluation/statistics/sample_quantile.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace overfly::evaluation {

double sample_quantile(std::vector<double> values, double share) {
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = values.begin() + static_cast<std::ptrdiff_t>(std::floor(place));
  std::nth_element(values.begin(), below, values.end());
  const auto above = below + 1 == values.end() ? below : std::min_element(below + 1, values.end());
  return *below + (place - std::floor(place)) * (*above - *below);
}

Quartiles quartiles_of(const std::vector<double>& values) {
  return {
      sample_quantile(values, 0.25), sample_quantile(values, 0.5), sample_quantile(values, 0.75)};
}

}  // namespace overfly::evaluation
