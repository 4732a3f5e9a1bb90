// Relocalises after tracking was lost.
#pragma once

#include <cstdint>
#include <optional>

#include "core/camera/camera.hpp"
#include "odometry/feature/map/map.hpp"
#include "odometry/feature/orb.hpp"

namespace overfly::odometry::feature {

struct RelocaliserOptions {
  int keyframes = 40;     ///< number of keyframes whose points are compared
  int max_distance = 64;  ///< bits
  double ratio = 0.85;    ///< best to second-best distance
  int rounds = 300;       ///< RANSAC iterations
  double threshold_px = 4.0;
  int min_inliers = 25;
  std::uint64_t seed = 1;
};

struct Relocalisation {
  int matches = 0;
  std::optional<Pose> T_camera_vo;
};

/// Matches an image's corners with the points of the newest keyframes.
///
/// Method: exhaustive descriptor search with a ratio test, three-point poses in RANSAC (Fischler
/// and Bolles 1981), and a pose fit to the inliers.
[[nodiscard]] Relocalisation relocalise(const PinholeCamera& camera,
                                        const RelocaliserOptions& options,
                                        const cv::Mat& image,
                                        OrbExtractor& orb,
                                        const Map& map);

}  // namespace overfly::odometry::feature
