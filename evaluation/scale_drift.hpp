// Errors of an estimate's scale over time.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>

namespace overfly::evaluation {

/// Distance between the true positions that are compared.
inline constexpr double kScaleWindow_m = 100.0;
/// Earlier places that are searched: 100 m at 2.6 m/s with 31 frames per second.
inline constexpr std::size_t kMaxScalePlaces = 1200;

/// Where a body truly was at an instant, and where the aligned estimate says it was.
struct ScalePlace {
  int map_id = 0;
  Eigen::Vector3d truth_world_m{0.0, 0.0, 0.0};
  Eigen::Vector3d estimate_world_m{0.0, 0.0, 0.0};
};

/// Scale of the estimate over the last 100 m against the truth: between an instant and the last one
/// that truly was at least kScaleWindow_m away, the estimated distance divided by the true one,
/// minus 1. 0 = the alignment's scale holds; 0.01 = the estimate is 1 % too large here. Empty where
/// no earlier place of the same map is far enough away.
/// @param places  of successive instants; empty where there is no estimate
/// @pre places[at] is not empty
[[nodiscard]] std::optional<double> scale_error_at(
    std::span<const std::optional<ScalePlace>> places, std::size_t at);

}  // namespace overfly::evaluation
