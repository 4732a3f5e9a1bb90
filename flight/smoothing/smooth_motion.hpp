// Makes one smooth motion of a log's positions and attitudes.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "flight/smoothing/motion_spline.hpp"
#include "flight/smoothing/noise_level.hpp"
#include "flight/smoothing/samples.hpp"
#include "flight/smoothing/time_offset.hpp"

namespace overfly::flight::smoothing {

inline constexpr double kMaxDurationS = 86400.0;
inline constexpr std::size_t kMaxSamples = 4'000'000;

struct SmoothingOptions {
  /// Samples this far from the smooth motion, and more than six standard deviations, are left out.
  double jump_m = 2.0;                    ///< (0, 1000]
  double jump_rad = 0.05235987755982988;  ///< (0, pi/2]; 3 deg
  /// How much the motion may change: white jerk [m^2/s^5] and white angular acceleration
  /// [rad^2/s^3]. Smaller values smooth more.
  double jerk_psd = 50.0;    ///< [1e-6, 1e6]
  double angular_psd = 0.3;  ///< [1e-6, 1e6]
  /// Added to the times of attitudes; empty: estimated, see estimate_time_offset().
  std::optional<double> time_offset_s = 0.0;  ///< [-2, 2]
  /// The body's attitude relative to the frame whose attitude was logged, e.g. of a tilted board.
  Eigen::Quaterniond R_logged_body = Eigen::Quaterniond::Identity();

  /// Errors: kInvalidArgument naming field, value and limit.
  [[nodiscard]] Status validate() const;
};

/// The aircraft at one instant.
struct MotionState {
  Eigen::Vector3d p_world_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_world_m_s = Eigen::Vector3d::Zero();
  Eigen::Quaterniond R_ned_body = Eigen::Quaterniond::Identity();
  Eigen::Vector3d omega_body_rad_s = Eigen::Vector3d::Zero();
};

/// A motion as a function of time: position with continuous acceleration, attitude with continuous
/// angular rate.
struct SmoothMotion {
  PositionSpline position;
  RotationSpline attitude;  ///< by the clock of the attitudes, of the frame that was logged
  double time_offset_s = 0.0;
  Eigen::Quaterniond R_logged_body = Eigen::Quaterniond::Identity();
  /// Where both are known, by the clock of the positions.
  double begin_s = 0.0;
  double end_s = 0.0;

  /// @param t_s  in [begin_s, end_s]
  [[nodiscard]] MotionState at(double t_s) const;
};

enum class JumpKind { kPositionOutliers, kPositionStep, kAttitudeOutliers, kYawStep };
[[nodiscard]] const char* to_string(JumpKind kind);  ///< "position_outliers", "yaw_step"

/// Samples in a row that were left out, or a step after which samples were shifted.
struct Jump {
  double t_s = 0.0;  ///< of the first sample
  JumpKind kind = JumpKind::kPositionOutliers;
  double size = 0.0;        ///< largest distance from the smooth motion, or of the step [m or rad]
  std::size_t samples = 0;  ///< left out; 0 for a step
};

/// A raw sample minus the smooth motion.
struct SampleResidual {
  double t_s = 0.0;
  /// East, north, up [m]; or a rotation vector in body axes [rad].
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  bool used = false;
  bool shifted = false;  ///< used after the shift of a step, which the residual contains
};

/// What the fit of one kind of samples tells.
struct FitReport {
  std::vector<SampleResidual> residuals;  ///< one for each sample
  double rms = 0.0;                       ///< of the used samples, after shifts [m or rad]
  std::size_t used = 0;
  std::size_t left_out = 0;
  std::size_t shifted = 0;
  double longest_gap_s = 0.0;  ///< between used samples
};

struct SmoothedMotion {
  SmoothMotion motion;
  PositionNoise position_noise;  ///< as used: at least 0.05 m
  double attitude_noise_rad = 0.0;
  FitReport positions;
  FitReport attitudes;
  std::vector<Jump> jumps;  ///< by time
  std::optional<TimeOffset> estimated_offset;
};

/// Called during smoothing: "positions" or "attitudes", and the share of this fit that is done
/// [0, 1]. A fit is repeated up to three times, when it has left out samples.
using SmoothingProgress = std::function<void(const std::string& step, double share)>;

/// Fits splines to samples, without outliers and steps.
///
/// Positions and attitudes are fitted apart, each with its own noise, which is estimated from the
/// samples. Jumps are found by screen_positions() and screen_attitudes(), and then by the residuals
/// of the fit. Where samples are missing the motion is bridged with the least jerk; the error of
/// such a bridge grows with the power 2.5 of the gap.
/// @param positions, attitudes  times strictly increasing by clocks that differ by
/// options.time_offset_s
/// Errors: as SmoothingOptions::validate; kUnreadable if there are fewer than 5 samples that agree,
/// more than kMaxSamples, a span above kMaxDurationS, noise above 50 m or 20 deg, or less than 1 s
/// in common;
/// as estimate_time_offset and fit_positions.
[[nodiscard]] Result<SmoothedMotion> smooth_motion(std::span<const PositionSample> positions,
                                                   std::span<const AttitudeSample> attitudes,
                                                   const SmoothingOptions& options,
                                                   const std::atomic<bool>* cancel = nullptr,
                                                   const SmoothingProgress& progress = {});

}  // namespace overfly::flight::smoothing
