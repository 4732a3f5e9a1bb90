// Errors of single estimates against the truth, for plots over time.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "server/timeline/row_alignment.hpp"
#include "server/timeline/run_timeline.hpp"

namespace overfly::server {

/// Error of an aligned camera pose at its frame: estimate minus truth.
struct EstimateError {
  double position_m = 0.0;
  double up_m = 0.0;
  /// Horizontal parts: in the direction of the true motion, and to its right. Empty while the
  /// camera moves by less than 1 m/s horizontally.
  std::optional<double> along_m;
  std::optional<double> across_m;
  double rotation_rad = 0.0;  ///< angle of the rotation from one to the other
};

/// @param rows  successive rows of the estimator
/// @return one entry for each row; empty while not tracking, without an alignment, and for a frame
///         that is not recorded
[[nodiscard]] std::vector<std::optional<EstimateError>> errors_of(
    const RunTimeline& timeline,
    std::size_t estimator,
    const std::vector<EstimateRow>& rows,
    const RowAlignment& alignment);

}  // namespace overfly::server
