#pragma once

#include <opencv2/core/core.hpp>

namespace ORB_SLAM2 {

/// Draws the last frame in blue, green, red, with 20 rows for a line of text below it.
class FrameDrawer {
 public:
  cv::Mat DrawFrame();
  cv::Mat last;
};

}  // namespace ORB_SLAM2
