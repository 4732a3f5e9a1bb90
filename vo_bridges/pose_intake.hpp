// Poses of an estimator that are none: one is a lost frame, many in a row are its end.
#pragma once

#include <string>
#include <vector>

#include "core/result.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly {

/// Why this is no pose of a camera: it is not finite, a coordinate is beyond 1e12 units, or the
/// quaternion's length is off 1 by more than 0.001. Empty where it is one.
[[nodiscard]] std::string fault_of(const Pose& T_vo_camera);

/// Judges the answers of one estimator, in the order of its frames.
class PoseIntake {
 public:
  /// So many answers in a row without a usable pose end the estimator: about a second at 31 Hz.
  static constexpr int kMostInARow = 30;
  /// So many are noted one by one.
  static constexpr int kMostNotes = 20;

  /// Makes an answer LOST that claims a pose which is none (VoEstimate::pose_fault, or found here),
  /// and notes it; normalises the quaternion of any other. A scene depth that is no length is left
  /// out.
  /// Errors: kInternal with the last reason, at the kMostInARow-th such answer in a row.
  [[nodiscard]] Status take(VoEstimate& estimate);
  /// Lines for the log since the last call.
  [[nodiscard]] std::vector<std::string> take_notes();

 private:
  void note(const EstimateSample& sample, const std::string& fault);

  int in_a_row_ = 0;
  int notes_made_ = 0;
  bool depth_noted_ = false;
  std::vector<std::string> notes_;
};

}  // namespace overfly
