#pragma once

#include <Eigen/Core>

namespace svo {

class Point {
 public:
  explicit Point(const Eigen::Vector3d& position) : pos_(position) {}
  Eigen::Vector3d pos_;
};

}  // namespace svo
