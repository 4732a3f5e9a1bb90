#include "flight/smoothing/smooth_motion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/motion/pose.hpp"
#include "core/text/number_text.hpp"
#include "flight/smoothing/screening.hpp"
#include "flight/smoothing/spline_fit.hpp"

namespace overfly::flight::smoothing {
namespace {

constexpr double kPositionKnotS = 0.1;
constexpr double kAttitudeKnotS = 0.05;
constexpr double kLeastNoiseM = 0.05;
constexpr double kLeastNoiseRad = 0.0003;
constexpr double kMostNoiseM = 50.0;
constexpr double kMostNoiseRad = 20.0 * kPi / 180.0;
constexpr double kShortestMotionS = 1.0;
/// After each fit, samples that are too far away are left out and it is repeated.
constexpr int kMaxFits = 4;

Error unusable(const std::string& what) { return {ErrorCode::kUnreadable, what}; }

template <typename Sample>
Status check_samples(std::span<const Sample> samples, const std::string& what) {
  if (samples.size() < 5) {
    return unusable(std::to_string(samples.size()) + " " + what + ": must be at least 5");
  }
  if (samples.size() > kMaxSamples) {
    return unusable(std::to_string(samples.size()) + " " + what + ": must be at most " +
                    std::to_string(kMaxSamples) + "; limit the times");
  }
  const double span_s = samples.back().t_s - samples.front().t_s;
  if (!(span_s <= kMaxDurationS)) {
    return unusable("the " + what + " span " + number_text(span_s) +
                    " s: must be at most 86400 s; limit the times");
  }
  return {};
}

Status check_noise(const SmoothedMotion& result) {
  const PositionNoise& noise = result.position_noise;
  const double largest_m = std::max(noise.horizontal_m, noise.vertical_m);
  if (!(largest_m <= kMostNoiseM)) {
    return unusable("the positions scatter by " + number_text(largest_m) +
                    " m: must be at most 50 m");
  }
  if (!(result.attitude_noise_rad <= kMostNoiseRad)) {
    return unusable("the attitudes scatter by " +
                    number_text(deg_from_rad(result.attitude_noise_rad)) +
                    " deg: must be at most 20 deg");
  }
  return {};
}

/// How positions are fitted: what the two kinds of samples do differently.
struct PositionKindOf {
  using Sample = PositionSample;
  using Spline = PositionSpline;
  static constexpr const char* kName = "positions";
  static constexpr double kKnotS = kPositionKnotS;
  static constexpr JumpKind kOutliers = JumpKind::kPositionOutliers;
  static constexpr JumpKind kStep = JumpKind::kPositionStep;

  const TrackLimits& limits;
  double psd;

  [[nodiscard]] std::optional<Screening> screen(std::span<const Sample> samples) const {
    return screen_positions(samples, limits);
  }
  [[nodiscard]] Result<Spline> fit(std::span<const Sample> samples,
                                   const SplineKnots& knots,
                                   const std::atomic<bool>* cancel,
                                   const FitProgress& progress) const {
    return fit_positions(samples, knots, limits.position_noise, psd, cancel, progress);
  }
  static Sample shifted(Sample sample, const Eigen::Vector3d& shift) {
    sample.p_world_m -= shift;
    return sample;
  }
  static Eigen::Vector3d residual(const Sample& sample, const Spline& spline) {
    return sample.p_world_m - spline.position_m(sample.t_s);
  }
  [[nodiscard]] bool is_outlier(const Eigen::Vector3d& residual) const {
    const PositionNoise& noise = limits.position_noise;
    return residual.head<2>().norm() >
               std::max(limits.position_jump_m, kGateSigmas * noise.horizontal_m) ||
           std::abs(residual.z()) >
               std::max(limits.position_jump_m, kGateSigmas * noise.vertical_m);
  }
};

struct AttitudeKindOf {
  using Sample = AttitudeSample;
  using Spline = RotationSpline;
  static constexpr const char* kName = "attitudes";
  static constexpr double kKnotS = kAttitudeKnotS;
  static constexpr JumpKind kOutliers = JumpKind::kAttitudeOutliers;
  static constexpr JumpKind kStep = JumpKind::kYawStep;

  const TrackLimits& limits;
  double psd;

  [[nodiscard]] std::optional<Screening> screen(std::span<const Sample> samples) const {
    return screen_attitudes(samples, limits);
  }
  [[nodiscard]] Result<Spline> fit(std::span<const Sample> samples,
                                   const SplineKnots& knots,
                                   const std::atomic<bool>* cancel,
                                   const FitProgress& progress) const {
    return fit_rotations(samples, knots, limits.attitude_noise_rad, psd, cancel, progress);
  }
  static Sample shifted(Sample sample, const Eigen::Vector3d& shift) {
    sample.R_ned_body = rotation_from_vector(-shift) * sample.R_ned_body;
    return sample;
  }
  static Eigen::Vector3d residual(const Sample& sample, const Spline& spline) {
    return vector_from_rotation(spline.rotation(sample.t_s).conjugate() * sample.R_ned_body);
  }
  [[nodiscard]] bool is_outlier(const Eigen::Vector3d& residual) const {
    return residual.norm() >
           std::max(limits.attitude_jump_rad, kGateSigmas * limits.attitude_noise_rad);
  }
};

/// Groups samples in a row that were left out.
template <typename Kind>
void list_outliers(const FitReport& report, std::vector<Jump>& jumps) {
  bool in_row = false;
  for (const SampleResidual& residual : report.residuals) {
    if (!residual.used && !in_row) jumps.push_back({residual.t_s, Kind::kOutliers, 0.0, 0});
    in_row = !residual.used;
    if (!in_row) continue;
    jumps.back().size = std::max(jumps.back().size, residual.residual.norm());
    ++jumps.back().samples;
  }
}

template <typename Kind>
void report_fit(std::span<const typename Kind::Sample> samples,
                const Screening& screening,
                const typename Kind::Spline& spline,
                FitReport& report) {
  double sum = 0.0;
  std::optional<double> last_s;
  report.residuals.reserve(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const bool used = screening.kept[i];
    const bool shifted = used && screening.shift[i].norm() > 0.0;
    report.residuals.push_back({samples[i].t_s, Kind::residual(samples[i], spline), used, shifted});
    if (!used) continue;
    ++report.used;
    if (shifted) ++report.shifted;
    sum += Kind::residual(Kind::shifted(samples[i], screening.shift[i]), spline).squaredNorm();
    if (last_s) report.longest_gap_s = std::max(report.longest_gap_s, samples[i].t_s - *last_s);
    last_s = samples[i].t_s;
  }
  report.left_out = samples.size() - report.used;
  report.rms = std::sqrt(sum / static_cast<double>(report.used));
}

/// Screens and fits samples of one kind.
template <typename Kind>
Result<typename Kind::Spline> fit_kind(std::span<const typename Kind::Sample> samples,
                                       const Kind& kind,
                                       const std::atomic<bool>* cancel,
                                       const SmoothingProgress& progress,
                                       FitReport& report,
                                       std::vector<Jump>& jumps) {
  std::optional<Screening> screening = kind.screen(samples);
  const std::string too_few = std::string("the ") + Kind::kName +
                              " are too erratic: no piece of at least 1 s and 5 samples is smooth";
  if (!screening) return unusable(too_few);
  typename Kind::Spline spline;
  FitProgress fit_progress;
  if (progress) fit_progress = [&](double share) { progress(Kind::kName, share); };
  for (int round = 0; round < kMaxFits; ++round) {
    std::vector<typename Kind::Sample> kept;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (screening->kept[i]) kept.push_back(Kind::shifted(samples[i], screening->shift[i]));
    }
    if (kept.size() < 5) return unusable(too_few);
    const SplineKnots knots =
        SplineKnots::covering(kept.front().t_s, kept.back().t_s, Kind::kKnotS);
    Result<typename Kind::Spline> fitted = kind.fit(kept, knots, cancel, fit_progress);
    if (!fitted) return fitted.error();
    spline = std::move(*fitted);
    if (round + 1 == kMaxFits) break;
    std::size_t dropped = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (!screening->kept[i]) continue;
      const auto sample = Kind::shifted(samples[i], screening->shift[i]);
      if (!kind.is_outlier(Kind::residual(sample, spline))) continue;
      screening->kept[i] = false;
      ++dropped;
    }
    if (dropped == 0) break;
  }
  report_fit<Kind>(samples, *screening, spline, report);
  list_outliers<Kind>(report, jumps);
  for (const SampleStep& step : screening->steps) {
    jumps.push_back({samples[step.sample].t_s, Kind::kStep, step.size.norm(), 0});
  }
  return spline;
}

}  // namespace

const char* to_string(JumpKind kind) {
  switch (kind) {
    case JumpKind::kPositionOutliers:
      return "position_outliers";
    case JumpKind::kPositionStep:
      return "position_step";
    case JumpKind::kAttitudeOutliers:
      return "attitude_outliers";
    case JumpKind::kYawStep:
      break;
  }
  return "yaw_step";
}

Status SmoothingOptions::validate() const {
  const auto check = [](const char* name, double value, double low, double high) -> Status {
    if (value >= low && value <= high) return {};
    return Error{ErrorCode::kInvalidArgument,
                 std::string(name) + " = " + number_text(value) + ": must be in [" +
                     number_text(low) + ", " + number_text(high) + "]"};
  };
  if (Status status = check("jump_m", jump_m, 1e-3, 1000.0); !status) return status;
  if (Status status = check("jump_rad", jump_rad, 1e-4, kPi / 2.0); !status) return status;
  if (Status status = check("jerk_psd", jerk_psd, 1e-6, 1e6); !status) return status;
  if (Status status = check("angular_psd", angular_psd, 1e-6, 1e6); !status) return status;
  if (std::abs(R_logged_body.norm() - 1.0) > 1e-6) {
    return Error{ErrorCode::kInvalidArgument, "R_logged_body: must be a unit quaternion"};
  }
  if (!time_offset_s) return {};
  return check("time_offset_s", *time_offset_s, -kMaxTimeOffsetS, kMaxTimeOffsetS);
}

MotionState SmoothMotion::at(double t_s) const {
  MotionState state;
  state.p_world_m = position.position_m(t_s);
  state.v_world_m_s = position.velocity_m_s(t_s);
  const double attitude_s = t_s - time_offset_s;
  state.R_ned_body = (attitude.rotation(attitude_s) * R_logged_body).normalized();
  state.omega_body_rad_s = R_logged_body.conjugate() * attitude.angular_rate_rad_s(attitude_s);
  return state;
}

Result<SmoothedMotion> smooth_motion(std::span<const PositionSample> positions,
                                     std::span<const AttitudeSample> attitudes,
                                     const SmoothingOptions& options,
                                     const std::atomic<bool>* cancel,
                                     const SmoothingProgress& progress) {
  if (Status status = options.validate(); !status) return status.error();
  if (Status status = check_samples(positions, PositionKindOf::kName); !status) {
    return status.error();
  }
  if (Status status = check_samples(attitudes, AttitudeKindOf::kName); !status) {
    return status.error();
  }
  SmoothedMotion result;
  const PositionNoise noise = position_noise(positions);
  result.position_noise = {std::max(noise.horizontal_m, kLeastNoiseM),
                           std::max(noise.vertical_m, kLeastNoiseM)};
  result.attitude_noise_rad = std::max(attitude_noise_rad(attitudes), kLeastNoiseRad);
  if (Status status = check_noise(result); !status) return status.error();
  const TrackLimits limits{
      result.position_noise, result.attitude_noise_rad, options.jump_m, options.jump_rad};

  SmoothMotion& motion = result.motion;
  Result<PositionSpline> position = fit_kind(positions,
                                             PositionKindOf{limits, options.jerk_psd},
                                             cancel,
                                             progress,
                                             result.positions,
                                             result.jumps);
  if (!position) return position.error();
  motion.position = std::move(*position);
  Result<RotationSpline> attitude = fit_kind(attitudes,
                                             AttitudeKindOf{limits, options.angular_psd},
                                             cancel,
                                             progress,
                                             result.attitudes,
                                             result.jumps);
  if (!attitude) return attitude.error();
  motion.attitude = std::move(*attitude);
  std::stable_sort(result.jumps.begin(), result.jumps.end(), [](const Jump& a, const Jump& b) {
    return a.t_s < b.t_s;
  });

  motion.R_logged_body = options.R_logged_body;
  motion.time_offset_s = options.time_offset_s.value_or(0.0);
  if (!options.time_offset_s) {
    // The lateral axis is the body's.
    RotationSpline body = motion.attitude;
    for (Eigen::Quaterniond& control : body.control) control = control * options.R_logged_body;
    const Result<TimeOffset> offset = estimate_time_offset(motion.position, body, cancel);
    if (!offset) return offset.error();
    result.estimated_offset = *offset;
    motion.time_offset_s = offset->offset_s;
  }
  const auto last_used_s = [](const FitReport& report) {
    const auto last = std::find_if(report.residuals.rbegin(),
                                   report.residuals.rend(),
                                   [](const SampleResidual& residual) { return residual.used; });
    return last->t_s;
  };
  motion.begin_s =
      std::max(motion.position.knots.begin_s, motion.attitude.knots.begin_s + motion.time_offset_s);
  motion.end_s =
      std::min(last_used_s(result.positions), last_used_s(result.attitudes) + motion.time_offset_s);
  if (!(motion.end_s - motion.begin_s >= kShortestMotionS)) {
    return unusable("positions and attitudes have less than 1 s in common");
  }
  return result;
}

}  // namespace overfly::flight::smoothing
