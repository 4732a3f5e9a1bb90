// An image at half, quarter, ... resolution, for aligning patches.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "core/image.hpp"

namespace overfly::odometry {

/// Level l has pixel (x, y) at (2^l x, 2^l y) of the full image (the levels share pixel 0).
/// Level 0 looks into the image's own buffer, which the pyramid keeps alive.
struct Pyramid {
  std::shared_ptr<const Image> source;
  std::vector<cv::Mat> levels;  ///< CV_8U

  [[nodiscard]] int level_count() const { return static_cast<int>(levels.size()); }
  [[nodiscard]] const cv::Mat& level(int l) const { return levels[static_cast<std::size_t>(l)]; }
};

inline constexpr int kPyramidLevels = 5;

/// Builds up to kPyramidLevels levels; stops before a side falls below 32 px.
[[nodiscard]] Pyramid build_pyramid(std::shared_ptr<const Image> image);

}  // namespace overfly::odometry
