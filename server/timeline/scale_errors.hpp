// Errors of an estimate's scale over time, for plots of scale drift.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "server/timeline/row_alignment.hpp"
#include "server/timeline/run_timeline.hpp"

namespace overfly::server {

/// Distance between the true positions that are compared.
inline constexpr double kScaleWindow_m = 100.0;
/// Earlier rows that are searched: 100 m at 2.6 m/s with 31 frames per second.
inline constexpr std::size_t kMaxScaleRows = 1200;

/// Scale of the aligned estimate over the last 100 m against the truth: between a row's frame and
/// the last one that truly was at least kScaleWindow_m away, the estimated distance divided by the
/// true one, minus 1. 0 = the alignment's scale holds; 0.01 = the estimate is 1 % too large here.
/// @param rows  successive rows of the estimator
/// @return one entry for each row; empty while not tracking, without an alignment, for a frame that
///         is not recorded, and where no earlier row of the same map is far enough away
[[nodiscard]] std::vector<std::optional<double>> scale_errors_of(
    const RunTimeline& timeline,
    std::size_t estimator,
    const std::vector<EstimateRow>& rows,
    const RowAlignment& alignment);

}  // namespace overfly::server
