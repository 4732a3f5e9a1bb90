// Image pyramid with half, quarter, ... resolution for patch alignment.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "core/camera/image.hpp"

namespace overfly::odometry {

inline constexpr int kBurntCellPx = 8;

/// Pixel (x, y) of level l lies at (2^l x, 2^l y) of the full image (all levels share pixel 0).
/// Level 0 refers to the image's own buffer, which the pyramid keeps alive.
struct Pyramid {
  std::shared_ptr<const Image> source;
  std::vector<cv::Mat> levels;  ///< CV_8U
  /// CV_8U, one pixel per square of kBurntCellPx: not 0 where the image is saturated; empty =
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

inline constexpr int kPyramidLevels = 5;

/// Builds up to kPyramidLevels levels; stops before a side becomes shorter than 32 px.
/// @param mark_burnt  sets `burnt`: saturated areas of a few cells and more, and one cell around
///                    them. Single white roofs and markings do not count.
[[nodiscard]] Pyramid build_pyramid(std::shared_ptr<const Image> image, bool mark_burnt = false);

/// Whether the image has visible texture: corners that remain after averaging. In the dark the
/// finest level is full of noise corners.
[[nodiscard]] bool shows_something(const Pyramid& pyramid);

}  // namespace overfly::odometry
