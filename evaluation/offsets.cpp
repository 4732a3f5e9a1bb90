#include "evaluation/offsets.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <vector>

#include "core/algebra/decompositions.hpp"
#include "core/motion/pose.hpp"
#include "evaluation/association.hpp"

namespace overfly::evaluation {
namespace {

constexpr std::int64_t kGridNs = 50'000'000;
constexpr std::int64_t kResolutionNs = 10'000;
constexpr std::size_t kMostSamples = 2000;
constexpr std::size_t kLeastSamples = 20;

/// Evenly chosen tracked samples that have truth at every offset of the range.
std::vector<EstimateSample> chosen_samples(const Trajectory& truth, const EstimateTrack& estimate) {
  std::vector<EstimateSample> inside;
  const std::optional<int> map_id = longest_map(estimate);
  for (const EstimateSample& sample : estimate.samples) {
    if (sample.state != TrackingState::kTracking || sample.map_id != map_id) continue;
    if (sample.t_ns - kMaxClockOffsetNs < truth.begin_ns()) continue;
    if (sample.t_ns + kMaxClockOffsetNs > truth.end_ns()) continue;
    inside.push_back(sample);
  }
  if (inside.size() <= kMostSamples) return inside;
  std::vector<EstimateSample> chosen;
  for (std::size_t i = 0; i < kMostSamples; ++i) {
    chosen.push_back(inside[i * inside.size() / kMostSamples]);
  }
  return chosen;
}

std::vector<MatchedPose> matches_at(const Trajectory& truth,
                                    const std::vector<EstimateSample>& samples,
                                    std::int64_t offset_ns) {
  std::vector<MatchedPose> matches;
  for (const EstimateSample& sample : samples) {
    const std::int64_t t_ns = sample.t_ns + offset_ns;
    if (const auto pose = truth.at(t_ns)) matches.push_back({t_ns, *pose, sample.T_vo_camera, {}});
  }
  return matches;
}

/// Position RMSE after sim3 alignment [m]; infinite without an alignment, or if gaps of the truth
/// take more than a tenth of the samples.
double rmse_at(const Trajectory& truth,
               const std::vector<EstimateSample>& samples,
               std::int64_t offset_ns) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const std::vector<MatchedPose> matches = matches_at(truth, samples, offset_ns);
  if (matches.size() * 10 < samples.size() * 9) return kNone;
  const Result<Similarity> S_world_vo = align(matches, AlignmentMode::kSim3, {});
  if (!S_world_vo) return kNone;
  double sum = 0.0;
  for (const MatchedPose& match : matches) {
    sum += (*S_world_vo * match.T_vo_camera.translation - match.T_world_camera.translation)
               .squaredNorm();
  }
  const double rmse_m = std::sqrt(sum / static_cast<double>(matches.size()));
  return std::isfinite(rmse_m) ? rmse_m : kNone;
}

/// Share of the mean square that is gone.
double explained_by(double before, double after) {
  return before > 0.0 ? 1.0 - (after * after) / (before * before) : 0.0;
}

/// The minimum between two offsets (golden-section search, Kiefer 1953).
std::int64_t minimum_between(const Trajectory& truth,
                             const std::vector<EstimateSample>& samples,
                             double low_ns,
                             double high_ns) {
  const double golden = (std::sqrt(5.0) - 1.0) / 2.0;
  const auto value = [&](double offset_ns) {
    return rmse_at(truth, samples, static_cast<std::int64_t>(offset_ns));
  };
  double a_ns = high_ns - golden * (high_ns - low_ns);
  double b_ns = low_ns + golden * (high_ns - low_ns);
  double at_a = value(a_ns);
  double at_b = value(b_ns);
  while (high_ns - low_ns > static_cast<double>(kResolutionNs)) {
    if (at_a <= at_b) {
      high_ns = b_ns;
      b_ns = a_ns;
      at_b = at_a;
      a_ns = high_ns - golden * (high_ns - low_ns);
      at_a = value(a_ns);
    } else {
      low_ns = a_ns;
      a_ns = b_ns;
      at_a = at_b;
      b_ns = low_ns + golden * (high_ns - low_ns);
      at_b = value(b_ns);
    }
  }
  return static_cast<std::int64_t>((low_ns + high_ns) / 2.0);
}

std::optional<ClockOffset> clock_offset(const Trajectory& truth,
                                        const std::vector<EstimateSample>& samples) {
  ClockOffset offset;
  offset.position_rmse_before_m = rmse_at(truth, samples, 0);
  // Nothing shows then what an offset explains.
  if (!std::isfinite(offset.position_rmse_before_m)) return std::nullopt;
  std::int64_t best_ns = 0;
  double best_m = offset.position_rmse_before_m;
  for (std::int64_t t_ns = -kMaxClockOffsetNs; t_ns <= kMaxClockOffsetNs; t_ns += kGridNs) {
    const double rmse_m = rmse_at(truth, samples, t_ns);
    if (rmse_m < best_m) {
      best_m = rmse_m;
      best_ns = t_ns;
    }
  }
  if (std::abs(best_ns) == kMaxClockOffsetNs) return std::nullopt;
  offset.offset_ns = minimum_between(truth,
                                     samples,
                                     static_cast<double>(best_ns - kGridNs),
                                     static_cast<double>(best_ns + kGridNs));
  offset.position_rmse_after_m = rmse_at(truth, samples, offset.offset_ns);
  offset.explained = explained_by(offset.position_rmse_before_m, offset.position_rmse_after_m);
  const double gain_m = offset.position_rmse_before_m - offset.position_rmse_after_m;
  if (!(offset.explained >= kLeastExplained && gain_m >= kLeastGainM)) return std::nullopt;
  return offset;
}

double rotation_rmse_deg(const std::vector<MatchedPose>& matches,
                         const Eigen::Quaterniond& R_world_vo,
                         const Eigen::Quaterniond& R_estimated_true) {
  double sum = 0.0;
  for (const MatchedPose& match : matches) {
    const double angle_rad = rotation_angle_rad(
        match.T_world_camera.rotation, R_world_vo * match.T_vo_camera.rotation * R_estimated_true);
    sum += angle_rad * angle_rad;
  }
  return deg_from_rad(std::sqrt(sum / static_cast<double>(matches.size())));
}

std::optional<MountOffset> mount_offset(const std::vector<MatchedPose>& matches) {
  if (matches.empty()) return std::nullopt;
  AlignmentRemarks remarks;
  const Result<Similarity> S_world_vo = align(matches, AlignmentMode::kSim3, {}, &remarks);
  if (!S_world_vo || remarks.degenerate) return std::nullopt;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const MatchedPose& match : matches) {
    const Eigen::Quaterniond R_world_estimated = S_world_vo->rotation * match.T_vo_camera.rotation;
    sum += (R_world_estimated.conjugate() * match.T_world_camera.rotation).toRotationMatrix();
  }
  const Svd3 parts = svd(sum);
  Eigen::Matrix3d sign = Eigen::Matrix3d::Identity();
  sign(2, 2) = (parts.U * parts.V.transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  MountOffset offset;
  offset.R_estimated_true =
      Eigen::Quaterniond(Eigen::Matrix3d(parts.U * sign * parts.V.transpose())).normalized();
  offset.rotation_rmse_before_deg =
      rotation_rmse_deg(matches, S_world_vo->rotation, Eigen::Quaterniond::Identity());
  offset.rotation_rmse_after_deg =
      rotation_rmse_deg(matches, S_world_vo->rotation, offset.R_estimated_true);
  offset.explained = explained_by(offset.rotation_rmse_before_deg, offset.rotation_rmse_after_deg);
  const double gain_deg = offset.rotation_rmse_before_deg - offset.rotation_rmse_after_deg;
  if (!(offset.explained >= kLeastExplained && gain_deg >= kLeastGainDeg)) return std::nullopt;
  return offset;
}

}  // namespace

Offsets find_offsets(const Trajectory& T_world_camera_truth, const EstimateTrack& estimate) {
  Offsets offsets;
  if (T_world_camera_truth.empty()) return offsets;
  const std::vector<EstimateSample> samples = chosen_samples(T_world_camera_truth, estimate);
  if (samples.size() < kLeastSamples) return offsets;
  offsets.clock = clock_offset(T_world_camera_truth, samples);
  const std::int64_t offset_ns = offsets.clock ? offsets.clock->offset_ns : 0;
  offsets.mount = mount_offset(matches_at(T_world_camera_truth, samples, offset_ns));
  return offsets;
}

}  // namespace overfly::evaluation
