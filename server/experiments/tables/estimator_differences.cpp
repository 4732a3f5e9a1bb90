#include "server/experiments/tables/estimator_differences.hpp"

#include <map>
#include <optional>

#include "core/cancel.hpp"

namespace overfly::server::experiments {
namespace {

using Quantity = std::optional<Spread> CellErrors::*;

/// Medians of one estimator by cell.
std::map<std::string, double> medians_by_cell(const std::vector<CellScores>& rows,
                                              const std::string& estimator,
                                              std::size_t convention,
                                              Quantity quantity) {
  std::map<std::string, double> medians;
  for (const CellScores& row : rows) {
    const std::optional<Spread>& spread = row.errors[convention].*quantity;
    if (row.estimator == estimator && spread) medians[row.cell.dump()] = spread->quartiles.median;
  }
  return medians;
}

EstimatorDifference compared(const std::map<std::string, double>& first,
                             const std::map<std::string, double>& second,
                             const DifferenceOptions& options) {
  EstimatorDifference result;
  std::vector<double> a;
  std::vector<double> b;
  for (const auto& [cell, value] : first) {
    const auto other = second.find(cell);
    if (other == second.end()) {
      ++result.only_first;
      continue;
    }
    a.push_back(value);
    b.push_back(other->second);
  }
  result.only_second = second.size() - a.size();
  if (a.empty()) return result;
  result.difference = evaluation::paired_bootstrap(a, b, options.bootstrap);
  result.second_median = evaluation::sample_quantile(b, 0.5);
  return result;
}

DifferenceVerdict verdict_of(const EstimatorDifference& result, double margin) {
  const evaluation::PairedDifference& d = result.difference;
  if (d.pairs < kLeastPairs) return DifferenceVerdict::kTooFewCells;
  const double reach = margin * result.second_median;
  if (-reach <= d.low && d.high <= reach) return DifferenceVerdict::kPracticallyEqual;
  if (result.p_adjusted > 0.05) return DifferenceVerdict::kNotDecided;
  if (d.high < 0.0) return DifferenceVerdict::kFirstBetter;
  return d.low > 0.0 ? DifferenceVerdict::kSecondBetter : DifferenceVerdict::kNotDecided;
}

bool baseline_in(const std::vector<CellScores>& rows, const std::string& estimator) {
  for (const CellScores& row : rows) {
    if (row.estimator == estimator) return row.baseline;
  }
  return false;
}

}  // namespace

Result<std::vector<EstimatorDifference>> estimator_differences(
    const std::vector<CellScores>& rows,
    const std::vector<std::string>& estimators,
    std::size_t convention,
    const DifferenceOptions& options,
    const std::atomic<bool>* cancel) {
  const std::pair<const char*, Quantity> quantities[] = {
      {"position_m", &CellErrors::position_m}, {"rotation_deg", &CellErrors::rotation_deg}};
  std::vector<EstimatorDifference> results;
  std::vector<std::size_t> judged;
  std::vector<double> p_values;
  for (const auto& [name, quantity] : quantities) {
    for (std::size_t i = 0; i < estimators.size(); ++i) {
      const auto first = medians_by_cell(rows, estimators[i], convention, quantity);
      for (std::size_t j = i + 1; j < estimators.size(); ++j) {
        if (baseline_in(rows, estimators[i]) && baseline_in(rows, estimators[j])) continue;
        if (is_cancelled(cancel)) return Error{ErrorCode::kCancelled, "cancelled"};
        EstimatorDifference result =
            compared(first, medians_by_cell(rows, estimators[j], convention, quantity), options);
        result.first = estimators[i];
        result.second = estimators[j];
        result.quantity = name;
        if (result.difference.pairs >= kLeastPairs) {
          judged.push_back(results.size());
          p_values.push_back(result.difference.p_value);
        }
        results.push_back(std::move(result));
      }
    }
  }
  const std::vector<double> adjusted = evaluation::holm_adjusted(p_values);
  for (std::size_t k = 0; k < judged.size(); ++k) results[judged[k]].p_adjusted = adjusted[k];
  for (EstimatorDifference& result : results) result.verdict = verdict_of(result, options.margin);
  return results;
}

}  // namespace overfly::server::experiments
