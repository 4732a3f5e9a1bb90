// Relative errors per distance: Geiger, Lenz, Urtasun 2012, "Are we ready for autonomous driving?
// The KITTI vision benchmark suite", sec. 3 (doi:10.1109/CVPR.2012.6248074).
#include <algorithm>
#include <numeric>

#include "evaluation/errors.hpp"

namespace overfly::evaluation {
namespace {

constexpr std::size_t kStartStep = 10;  // poses between starts of segments, as in the benchmark

/// Distance along the truth's path at each match [m].
std::vector<double> distances_of(const std::vector<MatchedPose>& matches) {
  std::vector<double> distances_m{0.0};
  for (std::size_t i = 1; i < matches.size(); ++i) {
    const double step_m =
        (matches[i].T_world_camera.translation - matches[i - 1].T_world_camera.translation).norm();
    distances_m.push_back(distances_m.back() + step_m);
  }
  return distances_m;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

std::vector<RelativeError> relative_errors(const std::vector<MatchedPose>& matches,
                                           const std::vector<Pose>& T_world_camera_estimate,
                                           const std::vector<double>& lengths_m) {
  const std::vector<double> distances_m = distances_of(matches);
  std::vector<RelativeError> result;
  for (const double length_m : lengths_m) {
    std::vector<double> translation;
    std::vector<double> rotation_rad_m;
    for (std::size_t first = 0; first < matches.size(); first += kStartStep) {
      const auto end =
          std::upper_bound(distances_m.begin(), distances_m.end(), distances_m[first] + length_m);
      if (end == distances_m.end()) break;
      const auto last = static_cast<std::size_t>(end - distances_m.begin());
      const Pose truth = matches[first].T_world_camera.inverse() * matches[last].T_world_camera;
      const Pose estimate =
          T_world_camera_estimate[first].inverse() * T_world_camera_estimate[last];
      const Pose error = estimate.inverse() * truth;
      translation.push_back(error.translation.norm() / length_m);
      rotation_rad_m.push_back(rotation_angle_rad(estimate.rotation, truth.rotation) / length_m);
    }
    if (translation.empty()) continue;
    RelativeError relative;
    relative.length_m = length_m;
    relative.pairs = static_cast<int>(translation.size());
    relative.translation_percent = 100.0 * rms(translation);
    relative.translation_mean_percent = 100.0 * mean(translation);
    relative.rotation_deg_per_100m = 100.0 * deg_from_rad(rms(rotation_rad_m));
    relative.rotation_mean_deg_per_100m = 100.0 * deg_from_rad(mean(rotation_rad_m));
    result.push_back(relative);
  }
  return result;
}

}  // namespace overfly::evaluation
