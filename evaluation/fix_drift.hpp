// The drift of an estimate between position fixes.
#pragma once

#include <string>

namespace overfly::evaluation {

/// How far off the estimate is when the next position fix comes, with a fix every interval_m along
/// the true path. A fix sets position and orientation to the truth; the scale stays as aligned.
struct FixDrift {
  double interval_m = 0.0;
  /// Fixes are tried at every tenth pose, so that it does not matter where the first one is.
  int segments = 0;
  int apart = 0;          ///< segments that fit into the path without overlap
  double median_m = 0.0;  ///< of the errors at the ends of the segments
  double worst_m = 0.0;
  double horizontal_median_m = 0.0;  ///< of their horizontal parts
  double horizontal_worst_m = 0.0;
  /// Why there is none; else empty.
  std::string unavailable = {};
};

}  // namespace overfly::evaluation
