#include "core/measure/quantile.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

namespace overfly {

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto count = static_cast<double>(values.size());
  const auto rank = std::clamp<std::ptrdiff_t>(
      std::llround(std::ceil(share * count - 1e-9)) - 1, 0, std::ssize(values) - 1);
  const auto at = values.begin() + rank;
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace overfly
