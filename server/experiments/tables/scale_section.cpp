#include "server/experiments/tables/scale_section.hpp"

#include <algorithm>
#include <utility>

#include "server/experiments/tables/table_parts.hpp"

namespace overfly::server::experiments {
namespace {

bool has_scale(const CellScores& row) { return row.start_scale_percent.has_value(); }

}  // namespace

DocumentSection scale_section(const SweepTables& tables) {
  DocumentSection section;
  section.heading = "Scale at the start";
  section.paragraphs = {
      "By how much the scale of init_scale is larger than that of the best fit to the whole flight "
      "(sim3), of flights with the outcome COMPLETED: median over the flights of a cell.",
      "It is part of the errors of convention paper: 1 % of it puts every pose off by 1 % of its "
      "distance from the first one."};
  section.notes = {"-: no completed flight determines both scales."};
  add_axes(tables.scores, section.table.columns);
  for (const std::string& estimator : tables.scores.estimators) {
    section.table.columns.push_back({estimator + " [%]", true});
  }
  if (std::none_of(tables.rows.begin(), tables.rows.end(), has_scale)) return section;
  for (const CellRows& rows : rows_by_cell(tables)) {
    std::vector<TableCell> line = axis_cells(tables.scores, cell_of(rows));
    for (const CellScores* row : rows) {
      const bool known = row != nullptr && has_scale(*row);
      line.push_back({row == nullptr ? ""
                      : known        ? error_number(row->start_scale_percent->quartiles.median)
                                     : "-",
                      false});
    }
    section.table.rows.push_back(std::move(line));
  }
  return section;
}

}  // namespace overfly::server::experiments
