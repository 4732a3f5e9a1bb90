#include "evaluation/statistics/sample_quantile.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace overfly::evaluation {

double sample_quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(place));
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - std::floor(place)) * (values[above] - values[below]);
}

Quartiles quartiles_of(const std::vector<double>& values) {
  return {
      sample_quantile(values, 0.25), sample_quantile(values, 0.5), sample_quantile(values, 0.75)};
}

}  // namespace overfly::evaluation
