// An image at half the resolution, for pyramids.
#pragma once

#include <opencv2/core.hpp>

namespace overfly::odometry {

inline constexpr int kSaturatedLevel = 250;  ///< grey level from which a pixel counts as saturated

struct HalfImage {
  cv::Mat image;         ///< CV_8U, ((columns + 1) / 2) x ((rows + 1) / 2)
  int saturated_px = 0;  ///< number of saturated pixels of the whole image
};

/// Smooths with the binomial filter of five pixels and takes every second one, as cv::pyrDown does,
/// with the same bits. Method: Burt and Adelson 1983, section III (DOI 10.1109/TCOM.1983.1095851).
/// @param image  CV_8U
[[nodiscard]] HalfImage halved(const cv::Mat& image);
/// By OpenCV, for machines without AVX2 and for small images.
[[nodiscard]] HalfImage halved_by_opencv(const cv::Mat& image);

/// The number of saturated pixels. @param image  CV_8U
[[nodiscard]] int count_saturated(const cv::Mat& image);

}  // namespace overfly::odometry
