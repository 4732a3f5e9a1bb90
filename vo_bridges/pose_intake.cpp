#include "vo_bridges/pose_intake.hpp"

#include <cmath>
#include <utility>

namespace overfly {
namespace {

/// Components with four decimals, as in many text files.
constexpr double kUnitTolerance = 1e-3;
/// Quaternions with a smaller deviation are not normalised.
constexpr double kExactlyUnit = 1e-12;
/// About the distance to the moon and back in millimetres.
constexpr double kFarthest = 1e12;

}  // namespace

std::string fault_of(const Pose& T_vo_camera) {
  const Eigen::Vector3d& position = T_vo_camera.translation;
  if (!position.allFinite()) return "the position is not finite";
  if (position.cwiseAbs().maxCoeff() > kFarthest) {
    return "the position is beyond 1e12 units";
  }
  const double norm = T_vo_camera.rotation.norm();
  if (!(std::abs(norm - 1.0) <= kUnitTolerance)) {
    return "the quaternion's norm is " + std::to_string(norm) + ": must be 1";
  }
  return {};
}

Status PoseIntake::take(VoEstimate& estimate) {
  EstimateSample& sample = estimate.sample;
  std::string fault = std::exchange(estimate.pose_fault, {});
  if (fault.empty() && sample.state == TrackingState::kTracking) {
    fault = fault_of(sample.T_vo_camera);
  }
  if (sample.scene_depth && !(std::isfinite(*sample.scene_depth) && *sample.scene_depth > 0.0)) {
    if (!std::exchange(depth_noted_, true)) {
      notes_.push_back("warning: frame " + std::to_string(sample.frame) +
                       ": scene depth = " + std::to_string(*sample.scene_depth) +
                       ": must be positive and finite; this and later such values are ignored");
    }
    sample.scene_depth.reset();
  }
  drop_points_not_finite(estimate);
  if (fault.empty()) {
    in_a_row_ = 0;
    take_covariance(estimate);
    if (sample.state != TrackingState::kTracking) sample.T_vo_camera = {};
    Eigen::Quaterniond& rotation = sample.T_vo_camera.rotation;
    if (std::abs(rotation.norm() - 1.0) > kExactlyUnit) rotation.normalize();
    return {};
  }
  note(sample, fault);
  sample.state = TrackingState::kLost;
  sample.T_vo_camera = {};
  sample.scene_depth.reset();
  sample.covariance.reset();
  estimate.covariance.clear();
  if (++in_a_row_ < kMostInARow) return {};
  return Error{ErrorCode::kInternal,
               std::to_string(kMostInARow) + " answers in a row had no usable pose, the last one " +
                   "for frame " + std::to_string(sample.frame) + ": " + fault};
}

void PoseIntake::take_covariance(VoEstimate& estimate) {
  EstimateSample& sample = estimate.sample;
  const std::vector<double> values = std::exchange(estimate.covariance, {});
  if (sample.state != TrackingState::kTracking) {
    sample.covariance.reset();
    return;
  }
  if (is_unstated(values)) return;
  const Result<PoseCovariance> covariance = pose_covariance_from(values);
  if (covariance) {
    sample.covariance = std::make_shared<const PoseCovariance>(*covariance);
    return;
  }
  sample.covariance_left_out = true;
  if (std::exchange(covariance_noted_, true)) return;
  notes_.push_back("warning: frame " + std::to_string(sample.frame) +
                   ": covariance: " + covariance.error().message +
                   "; this and later such covariances are left out and counted");
}

void PoseIntake::drop_points_not_finite(VoEstimate& estimate) {
  const std::size_t dropped = std::erase_if(
      estimate.map_points_vo, [](const Eigen::Vector3f& point) { return !point.allFinite(); });
  if (dropped == 0 || std::exchange(points_noted_, true)) return;
  notes_.push_back("warning: frame " + std::to_string(estimate.sample.frame) +
                   ": a map point is not finite: this and later such points are left out");
}

void PoseIntake::note(const EstimateSample& sample, const std::string& fault) {
  if (notes_made_ >= kMostNotes) return;
  std::string line = "warning: frame " + std::to_string(sample.frame) + ": " + fault +
                     "; the frame counts as LOST";
  if (++notes_made_ == kMostNotes) line += " (further ones are not reported)";
  notes_.push_back(std::move(line));
}

std::vector<std::string> PoseIntake::take_notes() { return std::exchange(notes_, {}); }

}  // namespace overfly
