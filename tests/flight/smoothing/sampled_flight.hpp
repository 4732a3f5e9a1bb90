// A true flight and what a logger would have recorded of it.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/earth/height_query.hpp"
#include "core/motion/pose.hpp"
#include "core/time.hpp"
#include "flight/flight.hpp"
#include "flight/normal_noise.hpp"
#include "flight/smoothing/smooth_motion.hpp"

namespace overfly::flight::testing {

/// The course over flat ground: straight legs and reversals with up to 45 deg of bank.
inline std::unique_ptr<TruthSource> true_course() {
  return std::move(fly_course({}, std::make_shared<FlatGround>(0.0))).value();
}

/// Three draws, the last component first. The arguments of a call are drawn in an order that
/// depends on the compiler.
inline Eigen::Vector3d noise_vector(NormalNoise& noise) {
  const double z = noise.draw();
  const double y = noise.draw();
  return {noise.draw(), y, z};
}

/// From east-north-up to north-east-down and back.
inline Eigen::Quaterniond R_ned_enu() {
  constexpr double kHalfRoot = 0.70710678118654752440;
  return {0.0, kHalfRoot, kHalfRoot, 0.0};
}

struct Recording {
  std::vector<smoothing::PositionSample> positions;
  std::vector<smoothing::AttitudeSample> attitudes;
};

struct Recorder {
  double position_hz = 10.0;
  double attitude_hz = 50.0;
  double horizontal_sigma_m = 0.2;
  double vertical_sigma_m = 0.3;
  double attitude_sigma_rad = rad_from_deg(0.2);
  double attitude_delay_s = 0.0;  ///< attitudes are stamped this much too late
  double duration_s = 130.0;
  std::uint64_t seed = 7;
};

inline Recording record(const Recorder& recorder) {
  Recording recording;
  NormalNoise noise(recorder.seed);
  const auto positions = true_course();
  const auto attitudes = true_course();
  const auto times = [&](double hz) { return static_cast<int>(recorder.duration_s * hz); };
  for (int i = 0; i < times(recorder.position_hz); ++i) {
    const double t_s = i / recorder.position_hz;
    const AircraftState state = **positions->state_at(ns_from_s(t_s));
    const Eigen::Vector3d error = noise_vector(noise).cwiseProduct(Eigen::Vector3d(
        recorder.horizontal_sigma_m, recorder.horizontal_sigma_m, recorder.vertical_sigma_m));
    recording.positions.push_back({t_s, state.T_world_body.translation + error});
  }
  for (int i = 0; i < times(recorder.attitude_hz); ++i) {
    const double t_s = i / recorder.attitude_hz;
    const AircraftState state = **attitudes->state_at(ns_from_s(t_s));
    const Eigen::Vector3d error = noise_vector(noise);
    recording.attitudes.push_back(
        {t_s + recorder.attitude_delay_s,
         R_ned_enu() * state.T_world_body.rotation *
             smoothing::rotation_from_vector(recorder.attitude_sigma_rad * error)});
  }
  return recording;
}

/// Root mean square distances of a smooth motion from another, in the time of both.
struct Distance {
  double position_m = 0.0;
  double attitude_rad = 0.0;
  double worst_position_m = 0.0;
  double worst_attitude_rad = 0.0;
};

/// @param reference  state at t [s]: position, R_ned_body
template <typename Reference>
Distance distance(const smoothing::SmoothMotion& motion, const Reference& reference) {
  Distance sum;
  int count = 0;
  for (double t_s = motion.begin_s; t_s <= motion.end_s; t_s += 1.0 / 31.0, ++count) {
    const smoothing::MotionState state = motion.at(t_s);
    const smoothing::MotionState other = reference(t_s);
    const double position_m = (state.p_world_m - other.p_world_m).norm();
    const double attitude_rad = rotation_angle_rad(state.R_ned_body, other.R_ned_body);
    sum.position_m += position_m * position_m;
    sum.attitude_rad += attitude_rad * attitude_rad;
    sum.worst_position_m = std::max(sum.worst_position_m, position_m);
    sum.worst_attitude_rad = std::max(sum.worst_attitude_rad, attitude_rad);
  }
  sum.position_m = std::sqrt(sum.position_m / count);
  sum.attitude_rad = std::sqrt(sum.attitude_rad / count);
  return sum;
}

/// The true course as a reference.
class TrueCourse {
 public:
  smoothing::MotionState operator()(double t_s) const {
    const AircraftState state = **flight_->state_at(ns_from_s(t_s));
    return {state.T_world_body.translation,
            state.v_body_world_m_s,
            R_ned_enu() * state.T_world_body.rotation,
            state.omega_body_rad_s};
  }

 private:
  std::unique_ptr<TruthSource> flight_ = true_course();
};

}  // namespace overfly::flight::testing
