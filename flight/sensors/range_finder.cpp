#include "flight/sensors/range_finder.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace overfly::flight {

std::optional<double> beam_range_m(const HeightQuery& ground,
                                   const Eigen::Vector3d& from,
                                   const Eigen::Vector3d& direction,
                                   double max_m) {
  const auto height_above_ground = [&](double along_m) {
    const Eigen::Vector3d at = from + along_m * direction;
    return at.z() - ground.ground_up_m(at.x(), at.y());
  };
  double above_m = 0.0;  // along the beam, the last place above the ground
  double height = height_above_ground(above_m);
  if (!(height > 0.0)) return 0.0;
  double below_m = 0.0;
  do {
    if (above_m >= max_m) return std::nullopt;
    below_m = std::min(above_m + std::max({1.0, 0.25 * height, 0.005 * above_m}), max_m);
    height = height_above_ground(below_m);
    if (height > 0.0) above_m = below_m;
  } while (height > 0.0);
  constexpr double kResolutionM = 1e-4;
  while (below_m - above_m > kResolutionM) {
    const double middle_m = 0.5 * (above_m + below_m);
    (height_above_ground(middle_m) > 0.0 ? above_m : below_m) = middle_m;
  }
  return 0.5 * (above_m + below_m);
}

RangeSample RangeFinder::measure(const AircraftState& state, const HeightQuery& ground) {
  const Eigen::Vector3d beam = state.T_world_body.rotation * Eigen::Vector3d::UnitZ();
  const double error_m = model_.noise_m * noise_.draw();
  const std::optional<double> range_m =
      beam_range_m(ground, state.T_world_body.translation, beam, model_.max_m);
  const bool echo = range_m && *range_m >= model_.min_m;
  return {state.t_ns,
          echo ? std::max(0.0, *range_m + error_m) : std::numeric_limits<double>::infinity()};
}

}  // namespace overfly::flight
