#include "evaluation/window_errors.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "evaluation/errors.hpp"

namespace overfly::evaluation {
namespace {

const Eigen::Vector3d& true_place(const PosePair& pair) { return pair.T_world_camera.translation; }

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

std::optional<RelativeErrorAt> relative_error_at(std::span<const std::optional<PosePair>> poses,
                                                 std::size_t at) {
  const PosePair& now = *poses[at];
  double path_m = 0.0;
  const PosePair* later = &now;
  for (std::size_t back = 1; back <= std::min(at, kMaxWindowPoses); ++back) {
    const std::optional<PosePair>& then = poses[at - back];
    if (!then) continue;
    if (then->map_id != now.map_id) return std::nullopt;
    path_m += (true_place(*later) - true_place(*then)).norm();
    later = &*then;
    if (path_m <= kErrorWindow_m) continue;
    const Pose truth = then->T_world_camera.inverse() * now.T_world_camera;
    const Pose estimate = then->T_world_camera_estimate.inverse() * now.T_world_camera_estimate;
    return RelativeErrorAt{(estimate.inverse() * truth).translation.norm() / kErrorWindow_m,
                           rotation_angle_rad(estimate.rotation, truth.rotation) / kErrorWindow_m};
  }
  return std::nullopt;
}

}  // namespace overfly::evaluation
