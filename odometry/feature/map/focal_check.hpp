// Checks whether the map's geometry contradicts the given focal length.
#pragma once

#include <optional>
#include <string>

#include "core/camera/camera.hpp"
#include "odometry/feature/map/map.hpp"

namespace overfly::odometry::feature {

/// Estimate of the focal length from a part of the map.
struct FocalEvidence {
  double scale = 1.0;  ///< best focal length / given focal length
  double sigma = 0.0;  ///< its standard deviation
};

struct FocalCheckOptions {
  int keyframes = 24;  ///< number of newest keyframes to adjust
  int points = 250;
  double min_rotation_rad = 0.15;  ///< between two keyframes, needed to observe the focal length
  double step = 0.06;              ///< between the tried scales, around 1
};

/// Adjusts a copy of the newest part of the map with the given, a smaller and a larger focal
/// length, and estimates the scale with the smallest error.
///
/// Method: profile of the adjustment error over one additional parameter. A parabola is fitted to
/// three values and the fit is repeated around its minimum; the residual at the minimum estimates
/// the noise.
/// @return empty if there are too few views or points, or if the error has no minimum nearby
[[nodiscard]] std::optional<FocalEvidence> focal_evidence(const PinholeCamera& camera,
                                                          const FocalCheckOptions& options,
                                                          const Map& map);

/// Collects evidence until it is conclusive.
class FocalCheck {
 public:
  explicit FocalCheck(const PinholeCamera& camera) : camera_(camera) {}

  /// Call after each keyframe; most calls return immediately.
  /// @return a warning, once, if the geometry contradicts the focal length
  [[nodiscard]] std::optional<std::string> after_keyframe(const Map& map);
  /// Starts a new map. Evidence so far is kept, because it concerns the camera.
  void new_map() { next_keyframe_ = 0; }

 private:
  PinholeCamera camera_;
  int next_keyframe_ = 0;  ///< keyframe id of the next evaluation
  int looks_ = 0;          ///< evaluations that gave evidence
  double weight_ = 0.0;
  double weighted_sum_ = 0.0;
  bool concluded_ = false;
};

}  // namespace overfly::odometry::feature
