// Draws the estimator's debug image.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "core/camera/image.hpp"
#include "core/motion/estimate.hpp"
#include "odometry/feature/start/initialiser.hpp"
#include "odometry/feature/tracker.hpp"

namespace overfly::odometry::feature {

struct DebugContent {
  TrackingState state = TrackingState::kInitialising;
  bool keyframe = false;
  int map_id = 0;
  int keyframes = 0;
  const TrackResult* tracked = nullptr;                       ///< null unless tracking
  const std::vector<Initialiser::Track>* followed = nullptr;  ///< null unless initialising
  std::vector<Eigen::Vector2d> missed_px;      ///< where points were searched but not found
  std::vector<Eigen::Vector2d> candidates_px;  ///< corners of a keyframe without depth yet
  /// Wall time by stage; null in lockstep, so that images are byte-identical between runs.
  const std::map<std::string, double>* timing_ms = nullptr;
};

/// Draws an RGB image, at half resolution for widths of 960 px and more.
/// Map points: green if found (larger for coarse patches), red if found at another place, grey if
/// not found. Corners of a new keyframe without depth are blue (only with one thread; a mapping
/// thread searches them later). Before the first map, followed corners and their paths are yellow.
/// Saturated areas are tinted. A line of text shows the state, and a blue frame marks a keyframe.
[[nodiscard]] Image draw_debug_view(const Pyramid& pyramid, const DebugContent& content);

}  // namespace overfly::odometry::feature
