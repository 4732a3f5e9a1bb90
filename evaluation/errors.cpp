#include "evaluation/errors.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace overfly::evaluation {

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

ErrorStatistics statistics_of(std::vector<double> errors) {
  ErrorStatistics statistics;
  statistics.rmse = rms(errors);
  statistics.mean =
      std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size());
  std::sort(errors.begin(), errors.end());
  const std::size_t middle = errors.size() / 2;
  statistics.median =
      errors.size() % 2 == 1 ? errors[middle] : 0.5 * (errors[middle - 1] + errors[middle]);
  statistics.max = errors.back();
  return statistics;
}

double area_under_curve(const std::vector<double>& errors_m, int frames, double limit_m) {
  double sum = 0.0;
  for (const double error_m : errors_m) {
    if (error_m < limit_m) sum += 1.0 - error_m / limit_m;
  }
  return sum / frames;
}

double euler_norm_rad(const Eigen::Quaterniond& R_world_body_a,
                      const Eigen::Quaterniond& R_world_body_b) {
  const RollPitchYaw a = attitude_from(R_world_body_a);
  const RollPitchYaw b = attitude_from(R_world_body_b);
  return Eigen::Vector3d(wrap_pi(a.roll_rad - b.roll_rad),
                         wrap_pi(a.pitch_rad - b.pitch_rad),
                         wrap_pi(a.yaw_rad - b.yaw_rad))
      .norm();
}

void add_errors(const std::vector<MatchedPose>& matches,
                const Options& options,
                AlignmentScore* score) {
  const Eigen::Quaterniond R_camera_body = options.T_body_camera.rotation.conjugate();
  std::vector<double> euler_deg;
  std::vector<double> horizontal_m;
  std::vector<double> vertical_m;
  std::vector<Pose> aligned;
  for (const MatchedPose& match : matches) {
    const Pose estimate = score->S_world_vo * match.T_vo_camera;
    const Pose& truth = match.T_world_camera;
    const Eigen::Vector3d error_m = estimate.translation - truth.translation;
    score->position_errors_m.push_back(error_m.norm());
    horizontal_m.push_back(error_m.head<2>().norm());
    vertical_m.push_back(error_m.z());
    if (!score->degenerate) {
      score->rotation_errors_deg.push_back(
          deg_from_rad(rotation_angle_rad(truth.rotation, estimate.rotation)));
    }
    euler_deg.push_back(deg_from_rad(
        euler_norm_rad(estimate.rotation * R_camera_body, truth.rotation * R_camera_body)));
    aligned.push_back(estimate);
  }
  score->matched = static_cast<int>(matches.size());
  score->position_m = statistics_of(score->position_errors_m);
  score->horizontal_rmse_m = rms(horizontal_m);
  score->vertical_rmse_m = rms(vertical_m);
  if (!score->degenerate) {
    score->rotation_deg = statistics_of(score->rotation_errors_deg);
    score->rotation_euler_norm_deg = statistics_of(euler_deg);
  }
  score->relative = relative_errors(matches, aligned, options.rpe_lengths_m);
  score->fix_drift = fix_drifts(matches, aligned, options.fix_intervals_m);
  score->consistency = consistency_of(matches, *score);
}

}  // namespace overfly::evaluation
