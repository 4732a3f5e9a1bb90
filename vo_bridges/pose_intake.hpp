// Checks poses of estimators. A single invalid pose counts as a lost frame; many in a row end the
// estimator.
#pragma once

#include <string>
#include <vector>

#include "core/result.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly {

/// Reason why a pose is invalid: it is not finite, a coordinate exceeds 1e12 units, or the
/// quaternion's norm differs from 1 by more than 0.001. Empty if it is valid.
[[nodiscard]] std::string fault_of(const Pose& T_vo_camera);

/// Checks the answers of one estimator, in frame order.
class PoseIntake {
 public:
  /// Number of consecutive answers without a valid pose that ends the estimator: about a second at
  /// 31 Hz.
  static constexpr int kMostInARow = 30;
  /// Maximum number of individual notes.
  static constexpr int kMostNotes = 20;

  /// Sets an answer with an invalid pose (VoEstimate::pose_fault, or found here) to LOST and adds a
  /// note. Normalises the quaternion of a valid pose. Drops a scene depth that is not positive and
  /// finite. Moves a valid covariance to the sample; marks the sample if it is invalid. Values that
  /// are all 0 state no covariance. Drops map points that are not finite.
  /// Errors: kInternal with the last reason after kMostInARow consecutive answers with invalid
  /// poses.
  [[nodiscard]] Status take(VoEstimate& estimate);
  /// Log lines since the last call.
  [[nodiscard]] std::vector<std::string> take_notes();

 private:
  void note(const EstimateSample& sample, const std::string& fault);
  void take_covariance(VoEstimate& estimate);
  void drop_points_not_finite(VoEstimate& estimate);

  int in_a_row_ = 0;
  int notes_made_ = 0;
  bool depth_noted_ = false;
  bool covariance_noted_ = false;
  bool points_noted_ = false;
  std::vector<std::string> notes_;
};

}  // namespace overfly
