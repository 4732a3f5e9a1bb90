#include "evaluation/window_errors.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "evaluation/errors.hpp"

namespace overfly::evaluation {
namespace {

const Eigen::Vector3d& true_place(const PosePair& pair) { return pair.T_world_camera.translation; }

RelativeErrorAt relative_error(const PosePair& then, const PosePair& now) {
  const Pose truth = then.T_world_camera.inverse() * now.T_world_camera;
  const Pose estimate = then.T_world_camera_estimate.inverse() * now.T_world_camera_estimate;
  return {(estimate.inverse() * truth).translation.norm() / kErrorWindow_m,
          rotation_angle_rad(estimate.rotation, truth.rotation) / kErrorWindow_m};
}

}  // namespace

std::optional<double> scale_error_at(std::span<const std::optional<PosePair>> poses,
                                     std::size_t at) {
  const PosePair& now = *poses[at];
  for (std::size_t back = 1; back <= std::min(at, kMaxWindowPoses); ++back) {
    const std::optional<PosePair>& then = poses[at - back];
    if (!then) continue;
    if (then->map_id != now.map_id) return std::nullopt;
    const double true_m2 = (true_place(now) - true_place(*then)).squaredNorm();
    if (true_m2 < kErrorWindow_m * kErrorWindow_m) continue;
    const double estimated_m =
        (now.T_world_camera_estimate.translation - then->T_world_camera_estimate.translation)
            .norm();
    return estimated_m / std::sqrt(true_m2) - 1.0;
  }
  return std::nullopt;
}

std::vector<std::optional<RelativeErrorAt>> relative_errors_along(
    std::span<const std::optional<PosePair>> poses) {
  std::vector<std::optional<RelativeErrorAt>> errors(poses.size());
  std::vector<std::size_t> known;  // of the present map: indices of its poses
  std::vector<double> path_m;      // and the true path to each
  std::size_t first = 0;           // in `known`: where the window begins
  for (std::size_t at = 0; at < poses.size(); ++at) {
    if (!poses[at]) continue;
    const PosePair& now = *poses[at];
    const PosePair* const last = known.empty() ? nullptr : &*poses[known.back()];
    if (last == nullptr || last->map_id != now.map_id) {
      known = {at};
      path_m = {0.0};
      first = 0;
      continue;
    }
    known.push_back(at);
    const double step_m = (true_place(now) - true_place(*last)).norm() + now.detour_m;
    path_m.push_back(path_m.back() + step_m);
    while (path_m.back() - path_m[first + 1] > kErrorWindow_m) ++first;
    const bool is_far = path_m.back() - path_m[first] > kErrorWindow_m;
    if (!is_far || at - known[first] > kMaxWindowPoses) continue;
    errors[at] = relative_error(*poses[known[first]], now);
  }
  return errors;
}

}  // namespace overfly::evaluation
