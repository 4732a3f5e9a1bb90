// Relative errors per distance: Geiger, Lenz, Urtasun 2012, "Are we ready for autonomous driving?
// The KITTI vision benchmark suite", sec. 3 (doi:10.1109/CVPR.2012.6248074).
#include <algorithm>
#include <numeric>
#include <utility>

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
    distances_m.push_back(distances_m.back() + (step_m + matches[i].detour_m));
  }
  return distances_m;
}

/// The poses at which a segment of the path begins and ends.
struct Segment {
  std::size_t first = 0;
  std::size_t last = 0;  ///< the first pose farther away than the segment's length
};

/// From every tenth pose on.
std::vector<Segment> segments_of(const std::vector<double>& distances_m, double length_m) {
  std::vector<Segment> segments;
  for (std::size_t first = 0; first < distances_m.size(); first += kStartStep) {
    const auto end =
        std::upper_bound(distances_m.begin(), distances_m.end(), distances_m[first] + length_m);
    if (end == distances_m.end()) break;
    segments.push_back({first, static_cast<std::size_t>(end - distances_m.begin())});
  }
  return segments;
}

/// Position error at `last` in the world's axes of an estimate that was set to the truth at
/// `first`.
Eigen::Vector3d drift_m(const std::vector<MatchedPose>& matches,
                        const std::vector<Pose>& T_world_camera_estimate,
                        std::size_t first,
                        std::size_t last) {
  const Pose moved = T_world_camera_estimate[first].inverse() * T_world_camera_estimate[last];
  return matches[first].T_world_camera * moved.translation -
         matches[last].T_world_camera.translation;
}

/// At most a million.
int whole_intervals(double path_m, double interval_m) {
  return static_cast<int>(std::min(1e6, path_m / interval_m));
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
    for (const auto& [first, last] : segments_of(distances_m, length_m)) {
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

std::vector<FixDrift> fix_drifts(const std::vector<MatchedPose>& matches,
                                 const std::vector<Pose>& T_world_camera_estimate,
                                 const std::vector<double>& intervals_m) {
  const std::vector<double> distances_m = distances_of(matches);
  std::vector<FixDrift> result;
  for (const double interval_m : intervals_m) {
    std::vector<double> errors_m;
    std::vector<double> horizontal_m;
    for (const auto& [first, last] : segments_of(distances_m, interval_m)) {
      // The end of the interval lies between two poses, and so does its error.
      const double end_m = distances_m[first] + interval_m;
      const double share =
          (end_m - distances_m[last - 1]) / (distances_m[last] - distances_m[last - 1]);
      const Eigen::Vector3d error_m =
          (1.0 - share) * drift_m(matches, T_world_camera_estimate, first, last - 1) +
          share * drift_m(matches, T_world_camera_estimate, first, last);
      errors_m.push_back(error_m.norm());
      horizontal_m.push_back(error_m.head<2>().norm());
    }
    FixDrift& drift = result.emplace_back();
    drift.interval_m = interval_m;
    if (errors_m.empty()) {
      drift.unavailable = "the scored path is " +
                          std::to_string(static_cast<long long>(distances_m.back())) + " m long";
      continue;
    }
    drift.segments = static_cast<int>(errors_m.size());
    drift.apart = std::min(drift.segments, whole_intervals(distances_m.back(), interval_m));
    const ErrorStatistics errors = statistics_of(std::move(errors_m));
    const ErrorStatistics horizontal = statistics_of(std::move(horizontal_m));
    drift.median_m = errors.median;
    drift.worst_m = errors.max;
    drift.horizontal_median_m = horizontal.median;
    drift.horizontal_worst_m = horizontal.max;
  }
  return result;
}

}  // namespace overfly::evaluation
