#pragma once

#include <Eigen/Core>

namespace svo {

class Point;

struct Feature {
  Eigen::Vector2d px;
  Point* point;
};

}  // namespace svo
