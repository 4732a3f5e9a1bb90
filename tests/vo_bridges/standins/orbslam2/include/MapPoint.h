#pragma once

#include <opencv2/core/core.hpp>

namespace ORB_SLAM2 {

class MapPoint {
 public:
  explicit MapPoint(const cv::Mat& position) : position_(position) {}
  cv::Mat GetWorldPos() { return position_.clone(); }
  bool isBad() { return false; }

 private:
  cv::Mat position_;
};

}  // namespace ORB_SLAM2
