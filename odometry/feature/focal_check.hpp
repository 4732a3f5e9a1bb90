// Whether the map's geometry contradicts the focal length it was made with.
#pragma once

#include <optional>
#include <string>

#include "core/camera.hpp"
#include "odometry/feature/map.hpp"

namespace overfly::odometry {

/// What a part of the map says about the focal length.
struct FocalEvidence {
  double scale = 1.0;  ///< that the views ask for, of the focal length given
  double sigma = 0.0;  ///< its standard deviation
};

struct FocalCheckOptions {
  int keyframes = 24;  ///< newest that are adjusted together
  int points = 250;
  double min_rotation_rad = 0.15;  ///< between two of them: views that never turn tell nothing
  double step = 0.06;              ///< of the scales that are tried beside 1
};

/// Adjusts a copy of the newest part of the map with the focal length given, and with a smaller and
/// a larger one, and takes the scale at which the error would be least.
///
/// Method: the profile of the adjustment's error over one more parameter, a parabola through three
/// of its values, again around the least of it; the residual left there stands for the noise.
/// @return empty where views or points are too few, or the error has no least value near
[[nodiscard]] std::optional<FocalEvidence> focal_evidence(const PinholeCamera& camera,
                                                          const FocalCheckOptions& options,
                                                          const Map& map);

/// Collects evidence until it is conclusive either way.
class FocalCheck {
 public:
  explicit FocalCheck(const PinholeCamera& camera) : camera_(camera) {}

  /// To be called after each keyframe; works seldom. @return the warning, once, when the
  /// geometry contradicts the focal length
  [[nodiscard]] std::optional<std::string> after_keyframe(const Map& map);
  /// For a new map: what was found so far stays, it is about the camera.
  void new_map() { next_keyframe_ = 0; }

 private:
  PinholeCamera camera_;
  int next_keyframe_ = 0;  ///< id of the keyframe after which it looks again
  int looks_ = 0;          ///< that told something
  double weight_ = 0.0;
  double weighted_sum_ = 0.0;
  bool concluded_ = false;
};

}  // namespace overfly::odometry
