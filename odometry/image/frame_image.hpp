// A frame as it is passed between the estimator's components.
#pragma once

#include <cstdint>

#include "odometry/image/pyramid.hpp"

namespace overfly::odometry {

/// An image with its stamp and its pyramid, as processed by the estimator.
struct FrameImage {
  std::int64_t index = 0;
  std::int64_t t_ns = 0;
  Pyramid pyramid;
};

}  // namespace overfly::odometry
