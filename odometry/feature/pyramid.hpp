// An image at half, quarter, ... resolution, for aligning patches.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "core/image.hpp"

namespace overfly::odometry {

inline constexpr int kBurntCellPx = 8;

/// Level l has pixel (x, y) at (2^l x, 2^l y) of the full image (the levels share pixel 0).
/// Level 0 looks into the image's own buffer, which the pyramid keeps alive.
struct Pyramid {
  std::shared_ptr<const Image> source;
  std::vector<cv::Mat> levels;  ///< CV_8U
  /// CV_8U, one pixel for a square of kBurntCellPx: not 0 where the image is burnt out; empty =
  /// nowhere.
  cv::Mat burnt;

  [[nodiscard]] int level_count() const { return static_cast<int>(levels.size()); }
  /// @pre the full-resolution pixel is in the image
  [[nodiscard]] bool burnt_at(const Eigen::Vector2d& pixel) const {
    if (burnt.empty()) return false;
    return burnt.at<std::uint8_t>(
               std::min(burnt.rows - 1, static_cast<int>(pixel.y()) / kBurntCellPx),
               std::min(burnt.cols - 1, static_cast<int>(pixel.x()) / kBurntCellPx)) != 0;
  }
  [[nodiscard]] const cv::Mat& level(int l) const { return levels[static_cast<std::size_t>(l)]; }
};

/// Where light has filled the sensor: areas of a few cells and more without grey levels, and one
/// cell around them. Single white roofs and markings are no such areas.
[[nodiscard]] cv::Mat find_burnt(const cv::Mat& image);

inline constexpr int kPyramidLevels = 5;

/// Builds up to kPyramidLevels levels; stops before a side falls below 32 px.
[[nodiscard]] Pyramid build_pyramid(std::shared_ptr<const Image> image);

/// Whether there is anything to see: corners that outlast averaging over pixels. In the dark the
/// finest level alone is full of corners, of noise.
[[nodiscard]] bool shows_something(const Pyramid& pyramid);

}  // namespace overfly::odometry
