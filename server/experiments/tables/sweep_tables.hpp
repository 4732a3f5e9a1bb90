// The tables of a sweep: errors of estimators next to each other, outcomes, differences.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "server/experiments/tables/estimator_differences.hpp"
#include "server/experiments/tables/published_errors.hpp"
#include "server/experiments/tables/table_document.hpp"

namespace overfly::server::experiments {

struct TableOptions {
  DifferenceOptions differences;
  std::optional<PublishedErrors> published;
  /// Estimator of the sweep -> published name, in addition to equal names.
  std::map<std::string, std::string> counterparts;
};

/// Everything that the tables show.
struct SweepTables {
  SweepScores scores;
  std::vector<CellScores> rows;  ///< as cell_scores
  /// As all_conventions().
  std::vector<std::vector<EstimatorDifference>> differences;
  std::vector<std::vector<OrderingAgreement>> orderings;
};

/// Errors: kInvalidArgument for a counterpart that is no estimator of the sweep or no published
/// name; kCancelled.
[[nodiscard]] Result<SweepTables> sweep_tables(SweepScores scores,
                                               const TableOptions& options,
                                               const std::atomic<bool>* cancel = nullptr);

/// The lowest error of each cell is highlighted; X: no flight counts; a dagger marks estimators
/// that do not beat the best baseline of the cell.
[[nodiscard]] TableDocument document_from(const SweepTables& tables, const TableOptions& options);

/// One line for each cell, estimator and convention, with a head.
[[nodiscard]] std::string csv_from(const SweepTables& tables);
[[nodiscard]] nlohmann::json json_from(const SweepTables& tables);

enum class TableFormat { kMarkdown, kLatex, kHtml, kCsv, kJson };
/// "markdown", "latex", "html", "csv", "json".
[[nodiscard]] std::optional<TableFormat> table_format_from(const std::string& text);
[[nodiscard]] std::string text_from(const SweepTables& tables,
                                    const TableOptions& options,
                                    TableFormat format);

/// Three significant digits: "0.0123", "1.23", "12.3", "1234"; with an exponent from 1e6 on, where
/// an estimator has diverged: "2.38e+12".
[[nodiscard]] std::string error_number(double value);

}  // namespace overfly::server::experiments
