#include "server/experiments/sweep_summary.hpp"

#include <cmath>
#include <iomanip>
#include <set>
#include <sstream>

#include "evaluation/statistics/sample_quantile.hpp"
#include "server/scoring/run_metrics_json.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

struct Errors {
  std::vector<double> positions_m;
  std::vector<double> rotations_deg;
};

void add_errors(const fs::path& folder,
                const SweepResult& result,
                evaluation::AlignmentMode mode,
                Errors& errors,
                CellSummary& summary) {
  const Result<RunMetrics> metrics = read_run_metrics(folder / result.run);
  if (!metrics) {
    summary.problems.push_back(metrics.error().message);
    return;
  }
  const auto estimator = metrics->estimators.find(result.estimator);
  if (estimator == metrics->estimators.end()) return;
  const auto& alignments = estimator->second.score.alignments;
  const auto alignment = alignments.find(mode);
  if (alignment == alignments.end()) return;
  const evaluation::AlignmentScore& score = alignment->second;
  if (std::isfinite(score.position_m.rmse)) errors.positions_m.push_back(score.position_m.rmse);
  if (score.rotation_deg && std::isfinite(score.rotation_deg->rmse)) {
    errors.rotations_deg.push_back(score.rotation_deg->rmse);
  }
}

std::optional<double> median_of(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return evaluation::sample_quantile(values, 0.5);
}

/// "X" without a successful flight; "-" if the alignment does not determine the error.
std::string error_text(const CellSummary& row, const std::optional<double>& value, int digits) {
  if (!value) return row.successes == 0 ? "X" : "-";
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << *value;
  return text.str();
}

std::string percent_text(double share) {
  return std::to_string(static_cast<int>(std::lround(100.0 * share)));
}

std::string rate_text(const CellSummary& row) {
  if (row.flights == 0) return "";
  const auto share = static_cast<double>(row.successes) / row.flights;
  return percent_text(share) + " [" + percent_text(row.success_interval.low) + ", " +
         percent_text(row.success_interval.high) + "]";
}

std::string outcomes_text(const CellSummary& row) {
  std::string text;
  for (const auto& [name, count] : row.outcomes) {
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + name;
  }
  if (row.failed > 0)
    text += (text.empty() ? "" : ", ") + std::to_string(row.failed) + " not flown";
  return text;
}

/// A text in a cell of a Markdown table.
std::string cell_markdown(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '|') safe += '\\';
    safe += c == '\n' || c == '\r' ? ' ' : c;
  }
  return safe;
}

CellSummary summary_of_cell(const FlownSweep& flown,
                            std::size_t cell,
                            const std::string& estimator,
                            const fs::path& folder,
                            evaluation::AlignmentMode mode) {
  CellSummary row;
  row.cell = flown.plan.cells()[cell].values;
  row.estimator = estimator;
  Errors errors;
  for (const SweepResult* result : flown.plan.results_of(cell, estimator, flown.results)) {
    if (!result->completed()) {
      ++row.failed;
      row.problems.push_back(result->error);
      continue;
    }
    ++row.flights;
    ++row.outcomes[evaluation::to_string(result->outcome)];
    row.runs.push_back(result->run);
    if (result->outcome != evaluation::Outcome::kCompleted) continue;
    ++row.successes;
    add_errors(folder, *result, mode, errors, row);
  }
  row.success_interval = evaluation::wilson_interval(row.successes, row.flights);
  row.position_rmse_median_m = median_of(errors.positions_m);
  row.rotation_rmse_median_deg = median_of(errors.rotations_deg);
  return row;
}

}  // namespace

std::vector<CellSummary> summary_of(const FlownSweep& flown,
                                    const fs::path& folder,
                                    evaluation::AlignmentMode mode) {
  std::vector<CellSummary> rows;
  for (std::size_t cell = 0; cell < flown.plan.cells().size(); ++cell) {
    for (const std::string& estimator : flown.plan.estimators()) {
      rows.push_back(summary_of_cell(flown, cell, estimator, folder, mode));
    }
  }
  return rows;
}

Json json_from(const std::vector<CellSummary>& summary) {
  Json rows = Json::array();
  for (const CellSummary& row : summary) {
    Json entry = {{"cell", row.cell},
                  {"estimator", row.estimator},
                  {"flights", row.flights},
                  {"successes", row.successes},
                  {"failed", row.failed},
                  {"outcomes", row.outcomes},
                  {"success_rate_95", {row.success_interval.low, row.success_interval.high}},
                  {"runs", row.runs},
                  {"problems", row.problems}};
    if (row.position_rmse_median_m) entry["position_rmse_median_m"] = *row.position_rmse_median_m;
    if (row.rotation_rmse_median_deg) {
      entry["rotation_rmse_median_deg"] = *row.rotation_rmse_median_deg;
    }
    rows.push_back(std::move(entry));
  }
  return rows;
}

std::string markdown_from(const Sweep& sweep,
                          const std::vector<CellSummary>& summary,
                          evaluation::AlignmentMode mode) {
  std::string head;
  std::string rule;
  for (const SweepAxis& axis : sweep.axes) {
    head +=
        "| " + cell_markdown(axis.label) + (axis.unit.empty() ? "" : " [" + axis.unit + "]") + " ";
    rule += "|---";
  }
  std::ostringstream text;
  text << head
       << "| estimator | flights | success [%] (95 %) | position RMSE [m] | rotation RMSE [deg] "
       << "| outcomes |\n"
       << rule << "|---|---|---|---|---|---|\n";
  for (const CellSummary& row : summary) {
    for (const SweepAxis& axis : sweep.axes) {
      const Json& value = row.cell.at(axis.name);
      text << "| " << cell_markdown(value.is_string() ? value.get<std::string>() : value.dump())
           << " ";
    }
    text << "| " << cell_markdown(row.estimator) << " | " << row.flights << " | " << rate_text(row)
         << " | " << error_text(row, row.position_rmse_median_m, 3) << " | "
         << error_text(row, row.rotation_rmse_median_deg, 4) << " | " << outcomes_text(row)
         << " |\n";
  }
  text << "\nErrors: median over the flights with the outcome COMPLETED, alignment "
       << evaluation::to_string(mode)
       << "; X: there are none; -: the alignment does not determine it.\n";
  return text.str();
}

}  // namespace overfly::server::experiments
