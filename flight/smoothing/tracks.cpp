#include "flight/smoothing/tracks.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "flight/smoothing/motion_spline.hpp"

namespace overfly::flight::smoothing {
namespace {

/// White jerk of a small aircraft, with a margin for aerobatics [m^2/s^5].
constexpr double kTrackJerkPsd = 100.0;
/// White angular acceleration, likewise [rad^2/s^3].
constexpr double kTrackAngularPsd = 5.0;
/// Before anything is known of them.
constexpr double kSpeedSigmaMS = 60.0;
constexpr double kAccelerationSigmaMS2 = 20.0;
constexpr double kRateSigmaRadS = 5.0;

/// Covariance of an axis after `dt_s`: F P F^T + Q of white jerk (Bar-Shalom, Li, Kirubarajan 2001,
/// section 6.2.3).
Eigen::Matrix3d spread(const Eigen::Matrix3d& covariance, double dt_s) {
  Eigen::Matrix3d F;
  F << 1, dt_s, 0.5 * dt_s * dt_s, 0, 1, dt_s, 0, 0, 1;
  const double d2 = dt_s * dt_s;
  const double d3 = d2 * dt_s;
  Eigen::Matrix3d Q;
  Q << d2 * d3 / 20, d2 * d2 / 8, d3 / 6, d2 * d2 / 8, d3 / 3, d2 / 2, d3 / 6, d2 / 2, dt_s;
  return F * covariance * F.transpose() + kTrackJerkPsd * Q;
}

Eigen::Matrix3d start_covariance(double sigma_m) {
  return Eigen::Vector3d(sigma_m * sigma_m,
                         kSpeedSigmaMS * kSpeedSigmaMS,
                         kAccelerationSigmaMS2 * kAccelerationSigmaMS2)
      .asDiagonal();
}

/// Updates the covariance of an axis whose position is measured. @return the gain
Eigen::Vector3d update_axis(Eigen::Matrix3d& covariance, double sigma_m) {
  const Eigen::Vector3d gain = covariance.col(0) / (covariance(0, 0) + sigma_m * sigma_m);
  const Eigen::RowVector3d row = covariance.row(0);
  covariance -= gain * row;
  covariance = 0.5 * (covariance + covariance.transpose()).eval();
  return gain;
}

double opening(double jump, double uncertainty, Gate gate) {
  const double open = std::max(jump, uncertainty);
  return gate == Gate::kReturn ? std::min(open, kReturnJumps * jump) : open;
}

/// A step over so long a gap that nothing is known of it is none.
TrackStep known(TrackStep step) {
  if (step.size.allFinite() && std::isfinite(step.sigma)) return step;
  return {Eigen::Vector3d::Zero(), 0.0, true};
}

}  // namespace

void PositionTrack::start(const PositionSample& sample) {
  t_s_ = sample.t_s;
  state_.x.setZero();
  state_.x.row(0) = sample.p_world_m.transpose();
  state_.horizontal = start_covariance(limits_.position_noise.horizontal_m);
  state_.vertical = start_covariance(limits_.position_noise.vertical_m);
}

PositionTrack::State PositionTrack::predicted(double t_s) const {
  const double dt_s = std::abs(t_s - t_s_);
  State next = state_;
  next.x.row(0) += dt_s * state_.x.row(1) + 0.5 * dt_s * dt_s * state_.x.row(2);
  next.x.row(1) += dt_s * state_.x.row(2);
  next.horizontal = spread(state_.horizontal, dt_s);
  next.vertical = spread(state_.vertical, dt_s);
  return next;
}

bool PositionTrack::fits(const PositionSample& sample, Gate gate) const {
  const State next = predicted(sample.t_s);
  const Eigen::Vector3d off_m = sample.p_world_m - next.x.row(0).transpose();
  const auto gate_m = [&](double variance_m2, double sigma_m) {
    return opening(
        limits_.position_jump_m, kGateSigmas * std::sqrt(variance_m2 + sigma_m * sigma_m), gate);
  };
  return off_m.head<2>().norm() <=
             gate_m(next.horizontal(0, 0), limits_.position_noise.horizontal_m) &&
         std::abs(off_m.z()) <= gate_m(next.vertical(0, 0), limits_.position_noise.vertical_m);
}

void PositionTrack::take(const PositionSample& sample) {
  state_ = predicted(sample.t_s);
  t_s_ = sample.t_s;
  const Eigen::Vector3d off_m = sample.p_world_m - state_.x.row(0).transpose();
  const Eigen::Vector3d horizontal =
      update_axis(state_.horizontal, limits_.position_noise.horizontal_m);
  const Eigen::Vector3d vertical = update_axis(state_.vertical, limits_.position_noise.vertical_m);
  state_.x.col(0) += horizontal * off_m.x();
  state_.x.col(1) += horizontal * off_m.y();
  state_.x.col(2) += vertical * off_m.z();
}

void PositionTrack::restart(const PositionSample& sample) {
  state_ = predicted(sample.t_s);
  t_s_ = sample.t_s;
  state_.x.row(0) = sample.p_world_m.transpose();
  for (auto [covariance, sigma_m] :
       {std::pair{&state_.horizontal, limits_.position_noise.horizontal_m},
        std::pair{&state_.vertical, limits_.position_noise.vertical_m}}) {
    covariance->row(0).setZero();
    covariance->col(0).setZero();
    (*covariance)(0, 0) = sigma_m * sigma_m;
  }
}

TrackStep PositionTrack::step(const PositionTrack& before, const PositionTrack& after) {
  const double middle_s = 0.5 * (before.t_s_ + after.t_s_);
  const State from = before.predicted(middle_s);
  State to = after.predicted(middle_s);
  to.x.row(1) = -to.x.row(1);  // The filter ran backward.
  const Eigen::DiagonalMatrix<double, 3> turned(1.0, -1.0, 1.0);
  const Eigen::Matrix3d difference = to.x - from.x;
  // Least squares of "difference = step in the first row + errors of both filters".
  const auto weights_of = [&](const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
    const Eigen::Matrix3d sum = a + turned * b * turned;
    return Eigen::Vector3d(sum.inverse().col(0));
  };
  const Eigen::Vector3d horizontal = weights_of(from.horizontal, to.horizontal);
  const Eigen::Vector3d vertical = weights_of(from.vertical, to.vertical);
  TrackStep step;
  step.size = {horizontal.dot(difference.col(0)) / horizontal[0],
               horizontal.dot(difference.col(1)) / horizontal[0],
               vertical.dot(difference.col(2)) / vertical[0]};
  step.sigma = std::sqrt(std::max(1.0 / horizontal[0], 1.0 / vertical[0]));
  step.continues =
      step.size.norm() <= std::max(before.limits_.position_jump_m, kGateSigmas * step.sigma);
  return known(step);
}

void AttitudeTrack::start(const AttitudeSample& sample) {
  t_s_ = sample.t_s;
  state_.R_ned_body = sample.R_ned_body;
  state_.rate_rad_s.setZero();
  const double sigma_rad = limits_.attitude_noise_rad;
  state_.covariance =
      Eigen::Vector2d(sigma_rad * sigma_rad, kRateSigmaRadS * kRateSigmaRadS).asDiagonal();
}

AttitudeTrack::State AttitudeTrack::predicted(double t_s) const {
  const double dt_s = std::abs(t_s - t_s_);
  State next = state_;
  next.R_ned_body = state_.R_ned_body * rotation_from_vector(state_.rate_rad_s * dt_s);
  Eigen::Matrix2d F;
  F << 1, dt_s, 0, 1;
  Eigen::Matrix2d Q;
  Q << dt_s * dt_s * dt_s / 3, dt_s * dt_s / 2, dt_s * dt_s / 2, dt_s;
  next.covariance = F * state_.covariance * F.transpose() + kTrackAngularPsd * Q;
  return next;
}

double AttitudeTrack::gate_rad(double variance_rad2, Gate gate) const {
  return opening(limits_.attitude_jump_rad, kGateSigmas * std::sqrt(variance_rad2), gate);
}

bool AttitudeTrack::fits(const AttitudeSample& sample, Gate gate) const {
  const State next = predicted(sample.t_s);
  const double sigma_rad = limits_.attitude_noise_rad;
  return vector_from_rotation(next.R_ned_body.conjugate() * sample.R_ned_body).norm() <=
         gate_rad(next.covariance(0, 0) + sigma_rad * sigma_rad, gate);
}

void AttitudeTrack::take(const AttitudeSample& sample) {
  state_ = predicted(sample.t_s);
  t_s_ = sample.t_s;
  const Eigen::Vector3d off_rad =
      vector_from_rotation(state_.R_ned_body.conjugate() * sample.R_ned_body);
  Eigen::Matrix2d& P = state_.covariance;
  const double sigma_rad = limits_.attitude_noise_rad;
  const Eigen::Vector2d gain = P.col(0) / (P(0, 0) + sigma_rad * sigma_rad);
  const Eigen::RowVector2d row = P.row(0);
  P -= gain * row;
  P = 0.5 * (P + P.transpose()).eval();
  state_.R_ned_body = (state_.R_ned_body * rotation_from_vector(gain[0] * off_rad)).normalized();
  state_.rate_rad_s += gain[1] * off_rad;
}

void AttitudeTrack::restart(const AttitudeSample& sample) {
  state_ = predicted(sample.t_s);
  t_s_ = sample.t_s;
  state_.R_ned_body = sample.R_ned_body;
  state_.covariance(0, 1) = state_.covariance(1, 0) = 0.0;
  state_.covariance(0, 0) = limits_.attitude_noise_rad * limits_.attitude_noise_rad;
}

TrackStep AttitudeTrack::step(const AttitudeTrack& before, const AttitudeTrack& after) {
  const double middle_s = 0.5 * (before.t_s_ + after.t_s_);
  const State from = before.predicted(middle_s);
  const State to = after.predicted(middle_s);
  const Eigen::Vector3d turn = vector_from_rotation(to.R_ned_body * from.R_ned_body.conjugate());
  // The rate about the vertical is the same in both yaws.
  const double rate_difference =
      -(to.R_ned_body * to.rate_rad_s).z() - (from.R_ned_body * from.rate_rad_s).z();
  const Eigen::DiagonalMatrix<double, 2> turned(1.0, -1.0);
  const Eigen::Matrix2d sum = from.covariance + turned * to.covariance * turned;
  const Eigen::Vector2d weights = sum.inverse().col(0);
  TrackStep step;
  step.size.z() = turn.z() + weights[1] * rate_difference / weights[0];
  step.sigma = std::sqrt(1.0 / weights[0]);
  step.continues = std::hypot(turn.x(), turn.y(), step.size.z()) <=
                   before.gate_rad(step.sigma * step.sigma, Gate::kNext);
  return known(step);
}

}  // namespace overfly::flight::smoothing
