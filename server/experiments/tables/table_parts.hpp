// Parts that the tables of a sweep share: rows of a cell, columns and cells of the axes, text of a
// spread.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "server/experiments/tables/sweep_tables.hpp"

namespace overfly::server::experiments {

/// The rows of one cell, by estimator; null where it did not fly.
using CellRows = std::vector<const CellScores*>;

/// Of every cell with a flight. They point into the tables.
[[nodiscard]] std::vector<CellRows> rows_by_cell(const SweepTables& tables);
/// @pre one of the rows is not null
[[nodiscard]] const nlohmann::json& cell_of(const CellRows& rows);

void add_axes(const SweepScores& scores, std::vector<TableColumn>& columns);

/// The values of the axes in a cell of the sweep.
[[nodiscard]] std::vector<TableCell> axis_cells(const SweepScores& scores,
                                                const nlohmann::json& cell);

/// Adds the columns of the axes and of the estimator.
void add_estimator_columns(const SweepScores& scores, std::vector<TableColumn>& columns);

/// The axes' values of a row, and its estimator.
[[nodiscard]] std::vector<TableCell> estimator_cells(const SweepScores& scores,
                                                     const CellScores& row);

/// X if no flight counts, - if those that count have no such value.
[[nodiscard]] std::string no_value_text(const CellErrors& errors);

/// "1.23 [1.1, 1.4]".
[[nodiscard]] std::string quartiles_text(const Spread& spread);

}  // namespace overfly::server::experiments
