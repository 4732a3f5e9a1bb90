// An estimator's output for one frame, as it is recorded and scored.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/motion/pose.hpp"
#include "core/motion/pose_covariance.hpp"

namespace overfly {

enum class TrackingState { kInitialising, kTracking, kLost };

/// "INITIALISING", "TRACKING", "LOST".
[[nodiscard]] const char* to_string(TrackingState state);
[[nodiscard]] std::optional<TrackingState> tracking_state_from(const std::string& text);

/// One output of an estimator. The frame `vo` has an arbitrary origin, rotation and scale.
struct EstimateSample {
  std::int64_t frame = 0;
  std::int64_t t_ns = 0;  ///< stamp of the image
  TrackingState state = TrackingState::kInitialising;
  Pose T_vo_camera;                   ///< valid only while tracking
  std::optional<double> scene_depth;  ///< of the ground on the optical axis, or median [vo units]
  int map_id = 0;                     ///< +1 at every reset: new origin, new scale
  PoseCovariancePtr covariance = nullptr;  ///< of T_vo_camera's error; null if not stated
  /// The estimator stated a covariance that is none: it is left out, and the pose is kept.
  bool covariance_left_out = false;
};

/// All outputs of one estimator in one run, ordered by frame.
struct EstimateTrack {
  std::string name;
  std::vector<EstimateSample> samples;
};

}  // namespace overfly
