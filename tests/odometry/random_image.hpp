// An image of noise.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <random>

namespace overfly::odometry::testing {

/// @return CV_8U, every grey level equally frequent
inline cv::Mat random_image(int columns, int rows, unsigned seed) {
  std::mt19937 generator(seed);
  cv::Mat image(rows, columns, CV_8U);
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(generator());
    }
  }
  return image;
}

}  // namespace overfly::odometry::testing
