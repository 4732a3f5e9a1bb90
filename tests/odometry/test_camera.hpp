#pragma once

#include "core/camera/camera.hpp"

namespace overfly::odometry {

/// A camera with round numbers: 1280x960 pixels, focal length 700 pixels, centred.
inline PinholeCamera camera() { return {1280, 960, 700.0, 700.0, 639.5, 479.5}; }

}  // namespace overfly::odometry
