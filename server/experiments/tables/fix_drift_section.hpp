// The table of the drift between position fixes.
#pragma once

#include <cstddef>

#include "server/experiments/tables/sweep_tables.hpp"

namespace overfly::server::experiments {

/// A row for each cell and estimator of which any flight is long enough; none if no flight is.
/// @param convention  index in all_conventions()
[[nodiscard]] DocumentSection fix_drift_section(const SweepTables& tables, std::size_t convention);

}  // namespace overfly::server::experiments
