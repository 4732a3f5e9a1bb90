// Matches corners of two images by their descriptors.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "odometry/feature/orb.hpp"

namespace overfly::odometry::feature {

struct DescribedCorners {
  std::vector<Corner> corners;
  std::vector<Descriptor> descriptors;  ///< one for each corner
};

/// Detects and describes all corners of an image.
[[nodiscard]] DescribedCorners describe_image(const cv::Mat& image, OrbExtractor& orb);

struct MatcherOptions {
  double radius_px = 150.0;  ///< around the expected pixel
  int max_distance = 60;     ///< bits
  double ratio = 0.85;       ///< best to second-best distance
  int max_scale_change = 3;  ///< levels
};

/// Matches each corner of `from` to at most one corner of `to`.
/// @param expected  full-resolution pixel in `to` around which each corner of `from` is searched
/// @return for each corner of `from` its index in `to`. Each index is used once, by the nearest
/// descriptor.
[[nodiscard]] std::vector<std::optional<std::size_t>> match_corners(
    const DescribedCorners& from,
    const DescribedCorners& to,
    const std::vector<Eigen::Vector2d>& expected,
    const MatcherOptions& options);

}  // namespace overfly::odometry::feature
