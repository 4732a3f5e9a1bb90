// A frame for estimators, from a synthetic image.
#pragma once

#include <memory>
#include <utility>

#include "core/time.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::odometry::testing {

/// Frame `index` of an undistorted camera at the default rate.
inline VoFrame test_frame(std::size_t index, const PinholeCamera& camera, Image image) {
  VoFrame frame;
  frame.index = static_cast<std::int64_t>(index);
  frame.t_ns = frame_time_ns(frame.index, FrameRate{});
  frame.intrinsics = camera;
  frame.image = std::make_shared<const Image>(std::move(image));
  return frame;
}

}  // namespace overfly::odometry::testing
