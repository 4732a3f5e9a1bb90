// Synthesises the measurements of an inertial measurement unit at the origin of the aircraft's body
// frame.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/motion/truth_source.hpp"
#include "core/result.hpp"

namespace overfly::flight {

/// Noise of an IMU. The defaults are the values for the ADIS16448 from the EuRoC data set (Burri et
/// al. 2016, IJRR 35(10)).
struct ImuModel {
  double rate_hz = 200.0;                            ///< (0, 10000]
  double gyroscope_noise_rad_s_sqrt_hz = 1.6968e-4;  ///< white noise density, >= 0
  double gyroscope_walk_rad_s2_sqrt_hz = 1.9393e-5;  ///< of the bias's random walk, >= 0
  double accelerometer_noise_m_s2_sqrt_hz = 2.0e-3;  ///< white noise density, >= 0
  double accelerometer_walk_m_s3_sqrt_hz = 3.0e-3;   ///< of the bias's random walk, >= 0

  /// An IMU without errors.
  [[nodiscard]] static ImuModel ideal(double rate_hz = 200.0);
  /// Errors: kInvalidArgument naming field, value and limit.
  [[nodiscard]] Status validate() const;
};

/// One sample, body axes (forward-right-down).
struct ImuReading {
  std::int64_t t_ns = 0;  ///< the middle of the sample's interval
  Eigen::Vector3d angular_rate_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force_m_s2 = Eigen::Vector3d::Zero();  ///< at rest: gravity upwards
  /// Bias contained in the sample (random walk): the ground truth for a filter.
  Eigen::Vector3d gyroscope_bias_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accelerometer_bias_m_s2 = Eigen::Vector3d::Zero();
};

/// Computes samples at k / rate from 0 to the end of the flight or `end_ns`, whichever is first.
///
/// Each sample is the mean over its interval [t - T/2, t + T/2]; the first and last use only the
/// half that was flown. Integrating the samples therefore reproduces the attitude exactly and the
/// velocity to second order in T:
///   omega = log(R(t - T/2)^T R(t + T/2)) / T,   f = R(t)^T ((v(t + T/2) - v(t - T/2)) / T - g),
/// R = R_world_body. The world frame is treated as inertial: the earth's rotation (15 deg/h, within
/// the noise of such a unit) is neglected, and gravity is constant and along -up. White noise of
/// density s has the standard deviation s / sqrt(T) per sample; a bias of walk density w grows by w
/// sqrt(T) per sample (Woodman 2007, UCAM-CL-TR-696, section 3.2).
///
/// @param flight        a truth source that has not been queried for a later time
/// @param gravity_m_s2  magnitude of gravity, > 0
/// @param keep_going    polled now and then; return false to cancel; may be empty
/// Errors: as ImuModel::validate; kCancelled; any error of the flight before its end.
[[nodiscard]] Result<std::vector<ImuReading>> synthesize_imu(
    TruthSource& flight,
    std::int64_t end_ns,
    const ImuModel& model,
    double gravity_m_s2,
    std::uint64_t seed,
    const std::function<bool()>& keep_going = {});

}  // namespace overfly::flight
