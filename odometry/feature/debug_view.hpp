// The picture of what the estimator sees.
#pragma once

#include <string>

#include "core/estimate.hpp"
#include "core/image.hpp"
#include "odometry/feature/initialiser.hpp"
#include "odometry/feature/tracker.hpp"

namespace overfly::odometry {

struct DebugContent {
  TrackingState state = TrackingState::kInitialising;
  bool keyframe = false;
  int map_id = 0;
  int keyframes = 0;
  const TrackResult* tracked = nullptr;                       ///< null unless tracking
  const std::vector<Initialiser::Track>* followed = nullptr;  ///< null unless initialising
};

/// Half-size RGB image: tracked points green (coarse patches larger), rejected ones red, corners
/// being followed before the first map yellow with their path; a line of text; a frame around
/// the image of a keyframe. No wall time in it: recorded images repeat byte for byte.
[[nodiscard]] Image draw_debug_view(const Pyramid& pyramid, const DebugContent& content);

}  // namespace overfly::odometry
