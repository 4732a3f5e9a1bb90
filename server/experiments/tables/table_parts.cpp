#include "server/experiments/tables/table_parts.hpp"

#include <algorithm>

namespace overfly::server::experiments {

std::vector<CellRows> rows_by_cell(const SweepTables& tables) {
  std::vector<CellRows> cells;
  auto row = tables.rows.begin();  // in the same order
  for (const nlohmann::json& cell : tables.scores.cells) {
    CellRows& found = cells.emplace_back();
    for (const std::string& estimator : tables.scores.estimators) {
      const bool has_row =
          row != tables.rows.end() && row->estimator == estimator && row->cell == cell;
      found.push_back(has_row ? &*row++ : nullptr);
    }
  }
  return cells;
}

const nlohmann::json& cell_of(const CellRows& rows) {
  const auto first = std::find_if(rows.begin(), rows.end(), [](const auto* r) { return r; });
  return (*first)->cell;
}

void add_axes(const SweepScores& scores, std::vector<TableColumn>& columns) {
  for (const ShownAxis& axis : scores.axes) {
    columns.push_back({axis.label + (axis.unit.empty() ? "" : " [" + axis.unit + "]"), true});
  }
}

std::vector<TableCell> axis_cells(const SweepScores& scores, const nlohmann::json& cell) {
  std::vector<TableCell> cells;
  for (const ShownAxis& axis : scores.axes) {
    const auto found = cell.find(axis.name);
    const bool absent = found == cell.end();
    cells.push_back({absent               ? ""
                     : found->is_string() ? found->get<std::string>()
                                          : found->dump(),
                     false});
  }
  return cells;
}

void add_estimator_columns(const SweepScores& scores, std::vector<TableColumn>& columns) {
  add_axes(scores, columns);
  columns.push_back({"estimator", false});
}

std::vector<TableCell> estimator_cells(const SweepScores& scores, const CellScores& row) {
  std::vector<TableCell> cells = axis_cells(scores, row.cell);
  cells.push_back({row.estimator, false});
  return cells;
}

std::string no_value_text(const CellErrors& errors) { return errors.flights > 0 ? "-" : "X"; }

std::string quartiles_text(const Spread& spread) {
  if (spread.flights < 2) return error_number(spread.quartiles.median);
  return error_number(spread.quartiles.median) + " [" + error_number(spread.quartiles.low) + ", " +
         error_number(spread.quartiles.high) + "]";
}

}  // namespace overfly::server::experiments
