// Filters that predict the next sample of a flight, and how surprising it is.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "flight/smoothing/noise_level.hpp"
#include "flight/smoothing/samples.hpp"

namespace overfly::flight::smoothing {

/// A prediction is refused if it differs by more than this many standard deviations.
inline constexpr double kGateSigmas = 6.0;

struct TrackLimits {
  PositionNoise position_noise;
  double attitude_noise_rad = 0.0;
  /// Smaller differences are never refused.
  double position_jump_m = 2.0;
  double attitude_jump_rad = 0.05;
};

/// What a filter compares a sample with.
enum class Gate {
  kNext,  ///< the uncertainty of its prediction
  /// The same, but at most kReturnJumps of the limits' jumps: after an excursion, a prediction is
  /// so uncertain that wrong samples would fit too.
  kReturn,
};
inline constexpr double kReturnJumps = 6.0;

/// How a flight's samples go on after an interruption: the difference that remains if rates (and
/// accelerations) agree on both sides, and its standard deviation.
struct TrackStep {
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  double sigma = 0.0;
  /// Within the gate: no step.
  bool continues = false;
};

/// Kalman filter of positions whose acceleration wanders: state position, velocity and
/// acceleration, driven by white jerk; the same model for all axes. Works forward or backward in
/// time.
class PositionTrack {
 public:
  using Sample = PositionSample;
  explicit PositionTrack(const TrackLimits& limits) : limits_(limits) {}

  void start(const PositionSample& sample);
  [[nodiscard]] bool fits(const PositionSample& sample, Gate gate) const;
  /// Updates the state with a sample. @pre started
  void take(const PositionSample& sample);
  /// Time of the last sample.
  [[nodiscard]] double time_s() const { return t_s_; }
  /// Continues at a sample after a step: the position is the sample's, the rest as predicted.
  void restart(const PositionSample& sample);

  /// The step between a filter that arrived at its end forward in time, and one that arrived
  /// backward from later.
  [[nodiscard]] static TrackStep step(const PositionTrack& before, const PositionTrack& after);

 private:
  struct State {
    Eigen::Matrix3d x;  ///< rows: position, velocity, acceleration in the direction of the filter
    Eigen::Matrix3d horizontal;  ///< covariances
    Eigen::Matrix3d vertical;
  };
  [[nodiscard]] State predicted(double t_s) const;

  TrackLimits limits_;
  double t_s_ = 0.0;
  State state_{Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero()};
};

/// Kalman filter of attitudes whose angular rate wanders: driven by white angular acceleration.
class AttitudeTrack {
 public:
  using Sample = AttitudeSample;
  explicit AttitudeTrack(const TrackLimits& limits) : limits_(limits) {}

  void start(const AttitudeSample& sample);
  [[nodiscard]] bool fits(const AttitudeSample& sample, Gate gate) const;
  void take(const AttitudeSample& sample);
  [[nodiscard]] double time_s() const { return t_s_; }
  void restart(const AttitudeSample& sample);

  /// As PositionTrack::step; the size is the yaw step in z [rad] and 0 in x and y. It continues if
  /// the whole rotation is within the gate.
  [[nodiscard]] static TrackStep step(const AttitudeTrack& before, const AttitudeTrack& after);

 private:
  struct State {
    Eigen::Quaterniond R_ned_body = Eigen::Quaterniond::Identity();
    Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();  ///< in the direction of the filter
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of each axis
  };
  [[nodiscard]] State predicted(double t_s) const;
  [[nodiscard]] double gate_rad(double variance_rad2, Gate gate) const;

  TrackLimits limits_;
  double t_s_ = 0.0;
  State state_;
};

}  // namespace overfly::flight::smoothing
