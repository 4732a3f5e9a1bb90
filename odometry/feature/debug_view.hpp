// The picture of what the estimator sees.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

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
  std::vector<Eigen::Vector2d> missed_px;      ///< where points were looked for in vain
  std::vector<Eigen::Vector2d> candidates_px;  ///< corners of a keyframe that wait for a depth
  /// Wall time by stage; null in lockstep, whose images repeat byte for byte.
  const std::map<std::string, double>* timing_ms = nullptr;
};

/// RGB image, half as wide and high from 960 px of width on. Map points by state: found green
/// (coarse patches larger), found elsewhere red, not found grey; corners of a new keyframe without
/// a depth blue (with one thread: beside tracking they are looked for later); before the first map
/// the corners being followed yellow with their path. Burnt-out areas are tinted. A line of text; a
/// blue frame around the image of a keyframe.
[[nodiscard]] Image draw_debug_view(const Pyramid& pyramid, const DebugContent& content);

}  // namespace overfly::odometry
