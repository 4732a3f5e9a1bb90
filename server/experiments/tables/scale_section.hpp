// The table of the estimators' scales at the start against those that fit the whole flight.
#pragma once

#include "server/experiments/tables/sweep_tables.hpp"
#include "server/experiments/tables/table_document.hpp"

namespace overfly::server::experiments {

/// Without rows if no completed flight determines both scales.
[[nodiscard]] DocumentSection scale_section(const SweepTables& tables);

}  // namespace overfly::server::experiments
