// Whether two estimators differ, on the cells that both of them flew.
#pragma once

#include <string>
#include <vector>

#include "evaluation/statistics/paired_bootstrap.hpp"
#include "server/experiments/tables/cell_scores.hpp"

namespace overfly::server::experiments {

struct DifferenceOptions {
  /// Two estimators are practically equal if the interval of their difference lies within this
  /// share of the second one's median on both sides of 0.
  double margin = 0.1;
  evaluation::PairedBootstrapOptions bootstrap;
};

enum class DifferenceVerdict {
  kFirstBetter,
  kSecondBetter,
  kPracticallyEqual,
  kNotDecided,
  kTooFewCells,  ///< below kLeastPairs
};

/// Fewer pairs give intervals that are too short.
inline constexpr std::size_t kLeastPairs = 5;

struct EstimatorDifference {
  std::string first;
  std::string second;
  std::string quantity;  ///< "position_m" or "rotation_deg"
  /// Of the cells' medians, first minus second; a cell counts if both have a value.
  evaluation::PairedDifference difference;
  double second_median = 0.0;   ///< over these cells
  double p_adjusted = 1.0;      ///< for all comparisons of the convention, by Holm's method
  std::size_t only_first = 0;   ///< cells in which only the first has a value
  std::size_t only_second = 0;  ///< cells in which only the second has a value
  DifferenceVerdict verdict = DifferenceVerdict::kTooFewCells;
};

/// Every pair of estimators, but for pairs of baselines. Better means: the interval does not
/// contain 0 and the adjusted p-value is at most 0.05.
/// @param convention  index of all_conventions()
/// Errors: kCancelled, within the time of one comparison.
[[nodiscard]] Result<std::vector<EstimatorDifference>> estimator_differences(
    const std::vector<CellScores>& rows,
    const std::vector<std::string>& estimators,
    std::size_t convention,
    const DifferenceOptions& options,
    const std::atomic<bool>* cancel = nullptr);

}  // namespace overfly::server::experiments
