#include "evaluation/statistics/paired_bootstrap.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "evaluation/statistics/sample_quantile.hpp"

namespace overfly::evaluation {

PairedDifference paired_bootstrap(const std::vector<double>& a,
                                  const std::vector<double>& b,
                                  const PairedBootstrapOptions& options) {
  std::vector<double> differences(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) differences[i] = a[i] - b[i];
  std::mt19937_64 generator(options.seed);
  std::vector<double> medians;
  medians.reserve(options.resamples);
  std::vector<double> drawn(differences.size());
  std::size_t not_above = 0;
  std::size_t not_below = 0;
  for (std::size_t k = 0; k < options.resamples; ++k) {
    for (double& value : drawn) value = differences[generator() % differences.size()];
    const double median = sample_quantile(drawn, 0.5);
    not_above += median <= 0.0 ? 1 : 0;
    not_below += median >= 0.0 ? 1 : 0;
    medians.push_back(median);
  }
  PairedDifference result;
  result.pairs = differences.size();
  result.median = sample_quantile(differences, 0.5);
  result.low = sample_quantile(medians, 0.025);
  result.high = sample_quantile(medians, 0.975);
  // The sample itself counts as one resample on either side (Davison and Hinkley 1997, ch. 4).
  const double rarer = static_cast<double>(std::min(not_above, not_below) + 1) /
                       static_cast<double>(options.resamples + 1);
  // All n differences have the same sign with a probability of 2^(1 - n) where there is none.
  const double least = std::exp2(1.0 - static_cast<double>(differences.size()));
  result.p_value = std::clamp(2.0 * rarer, least, 1.0);
  return result;
}

std::vector<double> holm_adjusted(const std::vector<double>& p_values) {
  std::vector<std::size_t> order(p_values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return p_values[i] < p_values[j];
  });
  std::vector<double> adjusted(p_values.size());
  double largest = 0.0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const auto still = static_cast<double>(order.size() - rank);
    largest = std::max(largest, std::min(1.0, still * p_values[order[rank]]));
    adjusted[order[rank]] = largest;
  }
  return adjusted;
}

}  // namespace overfly::evaluation
