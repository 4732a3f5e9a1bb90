#include "renderer/ground/ground_ray.hpp"

#include <algorithm>

namespace overfly::renderer {

std::optional<Eigen::Vector3d> cast_to_ground(const HeightQuery& ground,
                                              const Eigen::Vector3d& origin_world,
                                              const Eigen::Vector3d& direction_world,
                                              double max_range_m) {
  const auto clearance_m = [&](double range_m) {
    const Eigen::Vector3d p = origin_world + range_m * direction_world;
    return p.z() - ground.ground_up_m(p.x(), p.y());
  };
  constexpr double kToleranceM = 0.01;
  double above_m = 0.0;
  double clearance = clearance_m(0.0);
  while (clearance > 0.0) {
    if (above_m >= max_range_m) return std::nullopt;
    double next_m = std::min(above_m + std::max(1.0, clearance / 3.0), max_range_m);
    clearance = clearance_m(next_m);
    if (clearance > 0.0) {
      above_m = next_m;
      continue;
    }
    while (next_m - above_m > kToleranceM) {
      const double middle_m = 0.5 * (above_m + next_m);
      (clearance_m(middle_m) > 0.0 ? above_m : next_m) = middle_m;
    }
    return origin_world + next_m * direction_world;
  }
  return origin_world;
}

double refine_depth(const HeightQuery& ground,
                    const Eigen::Vector3d& origin_world,
                    const Eigen::Vector3d& direction_world,
                    double depth_m) {
  const auto clearance_m = [&](double at_m) {
    const Eigen::Vector3d p = origin_world + at_m * direction_world;
    return p.z() - ground.ground_up_m(p.x(), p.y());
  };
  double best_m = depth_m;
  double previous_m = best_m - std::max(0.1, 1e-3 * best_m);
  double previous_clearance_m = clearance_m(previous_m);
  for (int step = 0; step < 6; ++step) {
    const double now_m = clearance_m(best_m);
    if (std::abs(now_m) < 1e-3 || now_m == previous_clearance_m) break;
    const double next_m = best_m - now_m * (best_m - previous_m) / (now_m - previous_clearance_m);
    if (!(std::abs(next_m - depth_m) < 0.02 * depth_m + 1.0)) return depth_m;
    previous_m = best_m;
    previous_clearance_m = now_m;
    best_m = next_m;
  }
  return best_m;
}

}  // namespace overfly::renderer
