// The sections of the tables of a sweep.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/text/number_text.hpp"
#include "server/experiments/tables/fix_drift_section.hpp"
#include "server/experiments/tables/scale_section.hpp"
#include "server/experiments/tables/table_parts.hpp"

namespace overfly::server::experiments {
namespace {

using Json = nlohmann::json;
using Quantity = std::optional<Spread> CellErrors::*;

struct ShownQuantity {
  const char* head;
  Quantity quantity;
};

constexpr ShownQuantity kPosition{"position [m]", &CellErrors::position_m};
constexpr ShownQuantity kRotation{"rotation [deg]", &CellErrors::rotation_deg};

/// Medians of one quantity in one cell, and which of them are the lowest.
struct CellMedians {
  std::vector<std::optional<double>> values;  ///< by estimator
  double lowest = std::numeric_limits<double>::infinity();
  double best_baseline = std::numeric_limits<double>::infinity();
};

CellMedians cell_medians(const CellRows& rows, std::size_t convention, Quantity quantity) {
  CellMedians medians;
  for (const CellScores* row : rows) {
    std::optional<double>& value = medians.values.emplace_back();
    if (row == nullptr) continue;
    const std::optional<Spread>& spread = row->errors[convention].*quantity;
    if (!spread) continue;
    value = spread->quartiles.median;
    medians.lowest = std::min(medians.lowest, *value);
    if (row->baseline) medians.best_baseline = std::min(medians.best_baseline, *value);
  }
  return medians;
}

/// "1.23", with the flights that count if others do not, and a dagger if a baseline is as good: if
/// only the baseline has a value, too.
TableCell median_cell(const CellRows& rows,
                      const CellMedians& medians,
                      std::size_t i,
                      std::size_t convention,
                      Quantity quantity) {
  const CellScores* const row = rows[i];
  if (row == nullptr) return {"", false};
  const CellErrors& errors = row->errors[convention];
  if (!medians.values[i]) {
    const bool beaten =
        errors.flights == 0 && !row->baseline && std::isfinite(medians.best_baseline);
    return {no_value_text(errors) + (beaten ? " †" : ""), false};
  }
  const double value = *medians.values[i];
  std::string text = error_number(value);
  const std::size_t counted = (errors.*quantity)->flights;
  if (counted < static_cast<std::size_t>(row->flights)) {
    text += " (" + std::to_string(counted) + "/" + std::to_string(row->flights) + ")";
  }
  if (!row->baseline && value >= medians.best_baseline) text += " †";
  return {text, rows.size() > 1 && value == medians.lowest};
}

DocumentTable error_table(const SweepTables& tables,
                          std::size_t convention,
                          const std::vector<ShownQuantity>& quantities) {
  DocumentTable table;
  add_axes(tables.scores, table.columns);
  for (const ShownQuantity& shown : quantities) {
    for (const std::string& estimator : tables.scores.estimators) {
      table.columns.push_back({estimator + " " + shown.head, true});
    }
  }
  for (const CellRows& rows : rows_by_cell(tables)) {
    std::vector<TableCell> line = axis_cells(tables.scores, cell_of(rows));
    for (const ShownQuantity& shown : quantities) {
      const CellMedians medians = cell_medians(rows, convention, shown.quantity);
      for (std::size_t i = 0; i < rows.size(); ++i) {
        line.push_back(median_cell(rows, medians, i, convention, shown.quantity));
      }
    }
    table.rows.push_back(std::move(line));
  }
  return table;
}

bool has_baseline(const SweepTables& tables) {
  return std::any_of(
      tables.rows.begin(), tables.rows.end(), [](const auto& row) { return row.baseline; });
}

DocumentSection error_section(const SweepTables& tables, std::size_t convention) {
  const ErrorConvention& c = all_conventions()[convention];
  DocumentSection section;
  section.heading = "Errors, convention " + c.name;
  section.paragraphs = {c.words + " RMSE of each flight, median over the flights of a cell."};
  section.table = error_table(tables, convention, {kPosition, kRotation});
  section.notes = {
      "Bold: the lowest of the cell. X: no flight counts; -: the alignment does not determine the "
      "error. (2/3): 2 of 3 flights count."};
  if (has_baseline(tables)) {
    section.notes.push_back(
        "†: the best baseline of the cell is at least as good, or only baselines have a value.");
  }
  return section;
}

DocumentSection parts_section(const SweepTables& tables, std::size_t convention) {
  DocumentSection section;
  section.heading =
      "Horizontal and vertical errors, convention " + all_conventions()[convention].name;
  section.paragraphs = {
      "RMSE of the horizontal and the vertical part of the position, without holding the last "
      "pose, and the position error as a share of the flown path."};
  section.table = error_table(tables,
                              convention,
                              {{"horizontal [m]", &CellErrors::horizontal_m},
                               {"vertical [m]", &CellErrors::vertical_m},
                               {"[% of path]", &CellErrors::percent_of_path}});
  return section;
}

std::string percent(double share) { return std::to_string(std::lround(100.0 * share)); }

DocumentSection outcome_section(const SweepTables& tables) {
  DocumentSection section;
  section.heading = "Outcomes and spread";
  section.paragraphs = {
      "Success: outcome COMPLETED, with Wilson's interval of 95 %. Errors: median and quartiles, "
      "convention " +
      sim3_convention().name + "."};
  add_axes(tables.scores, section.table.columns);
  for (const char* head : {"estimator", "outcomes"}) section.table.columns.push_back({head, false});
  for (const char* head : {"flights", "success [%]", "position [m]", "rotation [deg]"}) {
    section.table.columns.push_back({head, true});
  }
  for (const CellScores& row : tables.rows) {
    std::vector<TableCell> line = axis_cells(tables.scores, row.cell);
    std::string outcomes;
    for (const auto& [name, count] : row.outcomes) {
      outcomes += (outcomes.empty() ? "" : ", ") + std::to_string(count) + " " + name;
    }
    if (row.texture_limited) outcomes += " ‡";
    const double share = static_cast<double>(row.completed) / row.flights;
    const CellErrors& errors = row.errors[1];
    line.push_back({row.estimator, false});
    line.push_back({outcomes, false});
    line.push_back({std::to_string(row.flights), false});
    line.push_back(
        {percent(share) + " [" + percent(row.success.low) + ", " + percent(row.success.high) + "]",
         false});
    for (const auto& spread : {errors.position_m, errors.rotation_deg}) {
      line.push_back({spread ? quartiles_text(*spread) : no_value_text(errors), false});
    }
    section.table.rows.push_back(std::move(line));
  }
  const auto limited = [](const CellScores& row) { return row.texture_limited; };
  if (std::any_of(tables.rows.begin(), tables.rows.end(), limited)) {
    section.notes = {
        "‡: the imagery is coarser than the camera's pixels (median below 0.5 texels per pixel): "
        "it "
        "limits the result, not only the estimator."};
  }
  return section;
}

bool states_covariances(const CellScores& row, std::size_t convention) {
  return row.errors[convention].honesty.flights > 0;
}

/// The marks of the estimators that state covariances.
DocumentSection honesty_section(const SweepTables& tables, std::size_t convention) {
  DocumentSection section;
  section.heading =
      "Honesty of stated covariances, convention " + all_conventions()[convention].name;
  section.paragraphs = {
      "Flights whose mean normalised estimation error squared is above (overconfident) or below "
      "(too cautious) its band of 95 %, and by which factor position errors exceed the stated "
      "standard deviations: median and quartiles over the flights."};
  add_estimator_columns(tables.scores, section.table.columns);
  for (const char* head : {"flights", "overconfident", "too cautious", "errors / stated"}) {
    section.table.columns.push_back({head, true});
  }
  for (const CellScores& row : tables.rows) {
    if (!states_covariances(row, convention)) continue;
    const CellHonesty& honesty = row.errors[convention].honesty;
    std::vector<TableCell> line = estimator_cells(tables.scores, row);
    for (const std::size_t count : {honesty.flights, honesty.overconfident, honesty.too_cautious}) {
      line.push_back({std::to_string(count), false});
    }
    const auto& ratio = honesty.deviation_ratio;
    line.push_back({ratio ? quartiles_text(*ratio) : "-", false});
    section.table.rows.push_back(std::move(line));
  }
  return section;
}

std::string verdict_text(const EstimatorDifference& result, double margin) {
  switch (result.verdict) {
    case DifferenceVerdict::kFirstBetter:
      return result.first + " is better";
    case DifferenceVerdict::kSecondBetter:
      return result.second + " is better";
    case DifferenceVerdict::kPracticallyEqual:
      return "practically equal (within " + percent(margin) + " %)";
    case DifferenceVerdict::kNotDecided:
      return "not decided";
    case DifferenceVerdict::kTooFewCells:
      break;
  }
  return "fewer than " + std::to_string(kLeastPairs) + " common cells";
}

DocumentSection difference_section(const SweepTables& tables,
                                   std::size_t convention,
                                   const DifferenceOptions& options) {
  DocumentSection section;
  section.heading =
      "Differences between estimators, convention " + all_conventions()[convention].name;
  section.paragraphs = {
      "Median of the differences of the cells' medians, first minus second, over the cells in "
      "which "
      "both have a value; interval of 95 % by " +
      std::to_string(options.bootstrap.resamples) +
      " resamples of a paired bootstrap; p-values adjusted for the number of comparisons by Holm's "
      "method. Better: the interval does not contain 0 and p is at most 0.05."};
  section.table.columns = {{"first", false},
                           {"second", false},
                           {"of", false},
                           {"cells", true},
                           {"only first / second", true},
                           {"difference", true},
                           {"95 %", true},
                           {"p", true},
                           {"verdict", false}};
  for (const EstimatorDifference& result : tables.differences[convention]) {
    const evaluation::PairedDifference& d = result.difference;
    const bool judged = d.pairs >= kLeastPairs;
    section.table.rows.push_back(
        {{result.first},
         {result.second},
         {result.quantity == "position_m" ? "position [m]" : "rotation [deg]"},
         {std::to_string(d.pairs)},
         {std::to_string(result.only_first) + " / " + std::to_string(result.only_second)},
         {d.pairs > 0 ? error_number(d.median) : "-"},
         {judged ? "[" + error_number(d.low) + ", " + error_number(d.high) + "]" : "-"},
         {judged ? error_number(result.p_adjusted) : "-"},
         {verdict_text(result, options.margin)}});
  }
  return section;
}

std::string published_text(const std::vector<std::optional<double>>& values, std::size_t i) {
  return values[i] ? error_number(*values[i]) : "X";
}

DocumentSection published_section(const SweepTables& tables, const PublishedErrors& published) {
  DocumentSection section;
  section.heading = "Published errors";
  section.paragraphs = {"Published: " + published.source + ". Own errors: convention " +
                        paper_convention().name + "."};
  section.table = error_table(tables, 0, {kPosition, kRotation});
  const std::vector<ShownQuantity> quantities{kPosition, kRotation};
  for (const ShownQuantity& shown : quantities) {
    for (const std::string& estimator : published.estimators) {
      section.table.columns.push_back({estimator + ", published, " + shown.head, true});
    }
  }
  const std::vector<CellRows> cells = rows_by_cell(tables);
  for (std::size_t row = 0; row < cells.size(); ++row) {
    const PublishedCell* const found = published.find(cell_of(cells[row]));
    for (const auto* values : {found != nullptr ? &found->position_m : nullptr,
                               found != nullptr ? &found->rotation_deg : nullptr}) {
      for (std::size_t i = 0; i < published.estimators.size(); ++i) {
        section.table.rows[row].push_back(
            {values != nullptr ? published_text(*values, i) : "", false});
      }
    }
  }
  for (std::size_t c = 0; c < all_conventions().size(); ++c) {
    for (const OrderingAgreement& agreement : tables.orderings[c]) {
      section.notes.push_back("Convention " + all_conventions()[c].name + ", " +
                              (agreement.quantity == "position_m" ? "position" : "rotation") +
                              ", " + agreement.first + " against " + agreement.second +
                              ": the same order as published in " + std::to_string(agreement.same) +
                              " of " + std::to_string(agreement.cells) +
                              " cells in which both have values here and there.");
    }
  }
  return section;
}

}  // namespace

TableDocument document_from(const SweepTables& tables, const TableOptions& options) {
  const SweepScores& scores = tables.scores;
  TableDocument document;
  document.title = scores.title.empty() ? "Sweep" : scores.title;
  document.paragraphs = {
      counted(scores.cells.size(), "cell") + ", " + counted(scores.estimators.size(), "estimator") +
      ", " + counted(scores.flights.size(), "completed flight") +
      (scores.failed > 0 ? ", " + std::to_string(scores.failed) + " that failed and are left out"
                         : "") +
      ". Overfly " + scores.version + "."};
  for (const std::string& problem : scores.problems) {
    document.paragraphs.push_back("Left out: " + problem);
  }
  if (scores.former_results > 0) {
    document.paragraphs.push_back("Left out: " + counted(scores.former_results, "result") +
                                  " of flights that the sweep no longer has");
  }
  for (std::size_t i = 0; i < all_conventions().size(); ++i) {
    document.sections.push_back(error_section(tables, i));
  }
  const auto is_published = [&](const Json& cell) {
    return options.published->find(cell) != nullptr;
  };
  if (options.published && std::none_of(scores.cells.begin(), scores.cells.end(), is_published)) {
    document.paragraphs.push_back(
        "No cell of this sweep is published in: " + options.published->source + ".");
  } else if (options.published) {
    document.sections.push_back(published_section(tables, *options.published));
  }
  document.sections.push_back(outcome_section(tables));
  DocumentSection scales = scale_section(tables);
  if (!scales.table.rows.empty()) document.sections.push_back(std::move(scales));
  for (std::size_t i = 0; i < all_conventions().size(); ++i) {
    DocumentSection honesty = honesty_section(tables, i);
    if (!honesty.table.rows.empty()) document.sections.push_back(std::move(honesty));
  }
  for (std::size_t i = 0; i < all_conventions().size(); ++i) {
    if (!tables.differences[i].empty()) {
      document.sections.push_back(difference_section(tables, i, options.differences));
    }
  }
  document.sections.push_back(parts_section(tables, 1));
  for (std::size_t i = 0; i < all_conventions().size(); ++i) {
    DocumentSection drift = fix_drift_section(tables, i);
    if (!drift.table.rows.empty()) document.sections.push_back(std::move(drift));
  }
  return document;
}

std::optional<TableFormat> table_format_from(const std::string& text) {
  if (text == "markdown") return TableFormat::kMarkdown;
  if (text == "latex") return TableFormat::kLatex;
  if (text == "html") return TableFormat::kHtml;
  if (text == "csv") return TableFormat::kCsv;
  if (text == "json") return TableFormat::kJson;
  return std::nullopt;
}

std::string text_from(const SweepTables& tables, const TableOptions& options, TableFormat format) {
  switch (format) {
    case TableFormat::kMarkdown:
      return markdown_from(document_from(tables, options));
    case TableFormat::kLatex:
      return latex_from(document_from(tables, options));
    case TableFormat::kHtml:
      return html_from(document_from(tables, options));
    case TableFormat::kCsv:
      return csv_from(tables);
    case TableFormat::kJson:
      return json_from(tables).dump(2) + "\n";
  }
  return "";
}

}  // namespace overfly::server::experiments
