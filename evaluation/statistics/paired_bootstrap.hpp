// Whether two paired samples differ: the paired bootstrap, and correction for many comparisons.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace overfly::evaluation {

struct PairedBootstrapOptions {
  std::size_t resamples = 10'000;
  std::uint64_t seed = 1;
};

/// The median of the differences a - b of n pairs, with what 95 % of the resamples give.
struct PairedDifference {
  std::size_t pairs = 0;
  double median = 0.0;
  double low = 0.0;   ///< 2.5 % quantile
  double high = 0.0;  ///< 97.5 % quantile
  /// Two-sided: twice the share of resamples on the rarer side of 0, counting those at 0 on both,
  /// within [2 / (resamples + 1), 1]; at least 2^(1 - n), as in the sign test, because the
  /// resamples of few differences of one sign are all on its side.
  double p_value = 1.0;
};

/// Percentile bootstrap (Efron and Tibshirani 1993, An Introduction to the Bootstrap, ch. 13) of
/// the median of paired differences: pairs are drawn with replacement. Deterministic for a seed.
/// @pre a.size() == b.size() > 0, all finite
[[nodiscard]] PairedDifference paired_bootstrap(const std::vector<double>& a,
                                                const std::vector<double>& b,
                                                const PairedBootstrapOptions& options = {});

/// p-values adjusted for their number (Holm 1979, Scand. J. Stat. 6, 65-70): rejecting those of at
/// most alpha keeps the probability of any false rejection at alpha. In the order of the input.
[[nodiscard]] std::vector<double> holm_adjusted(const std::vector<double>& p_values);

}  // namespace overfly::evaluation
