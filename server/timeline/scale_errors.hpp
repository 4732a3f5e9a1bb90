// Errors of an estimate's scale over time, for plots of scale drift.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "server/timeline/row_alignment.hpp"
#include "server/timeline/run_timeline.hpp"

namespace overfly::server {

/// evaluation::scale_error_at of each row.
/// @param rows  successive rows of the estimator
/// @return one entry for each row; empty while not tracking, without an alignment, for a frame that
///         is not recorded, and where no earlier row of the same map is far enough away
[[nodiscard]] std::vector<std::optional<double>> scale_errors_of(
    const RunTimeline& timeline,
    std::size_t estimator,
    const std::vector<EstimateRow>& rows,
    const RowAlignment& alignment);

}  // namespace overfly::server
