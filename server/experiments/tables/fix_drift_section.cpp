#include "server/experiments/tables/fix_drift_section.hpp"

#include <algorithm>
#include <utility>

#include "core/text/number_text.hpp"
#include "server/experiments/tables/table_parts.hpp"

namespace overfly::server::experiments {
namespace {

bool has_drift(const CellErrors& errors) {
  return std::any_of(errors.fix_drift.begin(), errors.fix_drift.end(), [](const auto& drift) {
    return drift.median_m.has_value();
  });
}

/// The median of the flights' medians with its quartiles, then the worst of all flights.
std::string drift_text(const CellFixDrift& drift) {
  if (!drift.median_m) return "-";
  return quartiles_text(*drift.median_m) + " / " + error_number(drift.worst_m);
}

}  // namespace

DocumentSection fix_drift_section(const SweepTables& tables, std::size_t convention) {
  DocumentSection section;
  section.heading =
      "Drift between position fixes, convention " + all_conventions()[convention].name;
  section.paragraphs = {
      "Position error when the next fix comes, with a fix of position and orientation every 1, 2 "
      "and 5 km of the path: median of each flight, then median and quartiles over the flights, "
      "and after the slash the worst of all. -: no flight is long enough."};
  add_estimator_columns(tables.scores, section.table.columns);
  for (const double interval_m : kFixIntervalsM) {
    section.table.columns.push_back({number_text(interval_m / 1000.0) + " km [m]", true});
  }
  for (const CellScores& row : tables.rows) {
    const CellErrors& errors = row.errors[convention];
    if (!has_drift(errors)) continue;
    std::vector<TableCell> line = estimator_cells(tables.scores, row);
    for (const CellFixDrift& drift : errors.fix_drift) line.push_back({drift_text(drift), false});
    section.table.rows.push_back(std::move(line));
  }
  return section;
}

}  // namespace overfly::server::experiments
