#include "evaluation/scale_drift.hpp"

#include <algorithm>
#include <cmath>

namespace overfly::evaluation {

std::optional<double> scale_error_at(std::span<const std::optional<ScalePlace>> places,
                                     std::size_t at) {
  const ScalePlace& now = *places[at];
  for (std::size_t back = 1; back <= std::min(at, kMaxScalePlaces); ++back) {
    const std::optional<ScalePlace>& then = places[at - back];
    if (!then) continue;
    if (then->map_id != now.map_id) return std::nullopt;
    const double true_m2 = (now.truth_world_m - then->truth_world_m).squaredNorm();
    if (true_m2 < kScaleWindow_m * kScaleWindow_m) continue;
    return (now.estimate_world_m - then->estimate_world_m).norm() / std::sqrt(true_m2) - 1.0;
  }
  return std::nullopt;
}

}  // namespace overfly::evaluation
