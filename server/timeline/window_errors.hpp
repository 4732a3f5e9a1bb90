// Errors of an estimate over the last 100 m, for plots over time.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "evaluation/window_errors.hpp"
#include "server/timeline/row_alignment.hpp"
#include "server/timeline/run_timeline.hpp"

namespace overfly::server {

/// Empty where no earlier row of the same map is far enough away.
struct WindowErrors {
  std::optional<double> scale;                          ///< evaluation::scale_error_at
  std::optional<evaluation::RelativeErrorAt> relative;  ///< evaluation::relative_errors_along
};

/// Of the camera's poses against the truth at their stamps, as in the score.
/// @param rows  successive rows of the estimator
/// @return one entry for each row; without errors while not tracking, without an alignment, and for
///         a stamp that the recorded frames do not reach
[[nodiscard]] std::vector<WindowErrors> window_errors_of(const RunTimeline& timeline,
                                                         std::size_t estimator,
                                                         const std::vector<EstimateRow>& rows,
                                                         const RowAlignment& alignment);

}  // namespace overfly::server
