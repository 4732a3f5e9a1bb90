// Corners of one image found again in another by their descriptors.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "odometry/feature/orb.hpp"

namespace overfly::odometry {

struct DescribedCorners {
  std::vector<Corner> corners;
  std::vector<Descriptor> descriptors;  ///< one for each corner
};

/// All corners of an image, described.
[[nodiscard]] DescribedCorners describe_image(const cv::Mat& image, OrbExtractor& orb);

struct MatcherOptions {
  double radius_px = 150.0;  ///< around the expected place
  int max_distance = 60;     ///< bits
  double ratio = 0.85;       ///< best to second-best distance
  int max_scale_change = 3;  ///< levels
};

/// @param expected  full-resolution pixel in `to` where each corner of `from` is looked for
/// @return for each corner of `from` its index in `to`, each of which is taken once, by the nearest
[[nodiscard]] std::vector<std::optional<std::size_t>> match_corners(
    const DescribedCorners& from,
    const DescribedCorners& to,
    const std::vector<Eigen::Vector2d>& expected,
    const MatcherOptions& options);

}  // namespace overfly::odometry
