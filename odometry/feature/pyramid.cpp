#include "odometry/feature/pyramid.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace overfly::odometry {

Pyramid build_pyramid(std::shared_ptr<const Image> image) {
  Pyramid pyramid;
  // OpenCV has no view of constant data; nothing here writes to it.
  auto* data = const_cast<std::uint8_t*>(image->data.data());
  pyramid.levels.emplace_back(image->height_px, image->width_px, CV_8U, data);
  pyramid.source = std::move(image);
  while (pyramid.level_count() < kPyramidLevels) {
    const cv::Mat& above = pyramid.levels.back();
    if (std::min(above.cols, above.rows) < 64) break;
    cv::Mat half;
    cv::pyrDown(above, half);
    pyramid.levels.push_back(half);
  }
  return pyramid;
}

}  // namespace overfly::odometry
