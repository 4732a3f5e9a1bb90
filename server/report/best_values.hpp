#pragma once

#include <algorithm>
#include <optional>
#include <vector>

namespace overfly::server::report {

/// Which values are the best: all equal ones, and none where fewer than two take part.
/// @param values  empty or not finite: takes no part
[[nodiscard]] inline std::vector<bool> best_of(const std::vector<std::optional<double>>& values,
                                               bool largest) {
  std::vector<double> taking_part;
  for (const std::optional<double>& value : values) {
    if (value && *value - *value == 0.0) taking_part.push_back(*value);
  }
  std::vector<bool> best(values.size(), false);
  if (taking_part.size() < 2) return best;
  const auto [low, high] = std::minmax_element(taking_part.begin(), taking_part.end());
  const double wanted = largest ? *high : *low;
  for (std::size_t i = 0; i < values.size(); ++i) best[i] = values[i] == wanted;
  return best;
}

}  // namespace overfly::server::report
