// Errors of single estimates against the truth, for plots over time.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "evaluation/axis_errors.hpp"
#include "evaluation/consistency.hpp"
#include "server/timeline/row_alignment.hpp"
#include "server/timeline/run_timeline.hpp"

namespace overfly::server {

/// Error of an aligned camera pose against the truth at its stamp, as in the score: estimate minus
/// truth.
struct EstimateError {
  evaluation::AxisError position;
  double rotation_rad = 0.0;  ///< angle of the rotation from one to the other
  /// Normalised error squared of the position; empty without a covariance that can be inverted.
  std::optional<double> position_nees = {};

  [[nodiscard]] double position_m() const {
    return std::hypot(position.along_m, position.across_m, position.up_m);
  }
};

/// Where position_nees of an honest estimator lies with a probability of 95 %.
[[nodiscard]] evaluation::Band position_nees_band();

/// @param rows  successive rows of the estimator
/// @return one entry for each row; empty while not tracking, without an alignment, and for a stamp
///         that the recorded frames do not reach
[[nodiscard]] std::vector<std::optional<EstimateError>> errors_of(
    const RunTimeline& timeline,
    std::size_t estimator,
    const std::vector<EstimateRow>& rows,
    const RowAlignment& alignment);

}  // namespace overfly::server
