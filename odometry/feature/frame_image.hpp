// A frame as the parts of the estimator pass it on.
#pragma once

#include <cstdint>

#include "odometry/feature/pyramid.hpp"

namespace overfly::odometry {

/// An image with its stamp, as the estimator works on it.
struct FrameImage {
  std::int64_t index = 0;
  std::int64_t t_ns = 0;
  Pyramid pyramid;
};

}  // namespace overfly::odometry
