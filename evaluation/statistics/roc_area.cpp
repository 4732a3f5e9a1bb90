#include "evaluation/statistics/roc_area.hpp"

#include <algorithm>

namespace overfly::evaluation {

std::optional<double> roc_area(const std::vector<double>& positive, std::vector<double> negative) {
  if (positive.empty() || negative.empty()) return std::nullopt;
  std::sort(negative.begin(), negative.end());
  double wins = 0.0;
  for (const double score : positive) {
    const auto [below, above] = std::equal_range(negative.begin(), negative.end(), score);
    wins +=
        static_cast<double>(below - negative.begin()) + 0.5 * static_cast<double>(above - below);
  }
  return wins / (static_cast<double>(positive.size()) * static_cast<double>(negative.size()));
}

}  // namespace overfly::evaluation
