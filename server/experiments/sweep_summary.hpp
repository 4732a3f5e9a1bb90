// What a sweep found, cell by cell.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/evaluation.hpp"
#include "evaluation/statistics/wilson.hpp"
#include "server/experiments/fly_sweep.hpp"

namespace overfly::server::experiments {

/// One estimator in one cell.
struct CellSummary {
  nlohmann::json cell;
  std::string estimator;
  int flights = 0;    ///< completed ones
  int successes = 0;  ///< with the outcome COMPLETED
  int failed = 0;     ///< that failed, which is not the estimator's doing
  std::map<std::string, int> outcomes;
  evaluation::ShareInterval success_interval;  ///< 95 %
  /// Over the flights with the outcome COMPLETED that have this alignment; empty if there are none.
  std::optional<double> position_rmse_median_m;
  std::optional<double> rotation_rmse_median_deg;
  std::vector<std::string> runs;  ///< folders, relative to the sweep's
  std::vector<std::string> problems;
};

/// One entry for each cell and estimator. Run folders that cannot be read are named in `problems`.
/// @param mode  alignment of the errors
[[nodiscard]] std::vector<CellSummary> summary_of(const FlownSweep& flown,
                                                  const std::filesystem::path& folder,
                                                  evaluation::AlignmentMode mode);
[[nodiscard]] nlohmann::json json_from(const std::vector<CellSummary>& summary);
/// A table in Markdown.
[[nodiscard]] std::string markdown_from(const Sweep& sweep,
                                        const std::vector<CellSummary>& summary,
                                        evaluation::AlignmentMode mode);

}  // namespace overfly::server::experiments
