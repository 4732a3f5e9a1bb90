// What an inertial measurement unit at the aircraft's body origin would have measured.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/result.hpp"
#include "core/truth_source.hpp"

namespace overfly::flight {

/// Noise of an IMU. The defaults are those of the ADIS16448 as the EuRoC data set gives them
/// (Burri et al. 2016, IJRR 35(10)).
struct ImuModel {
  double rate_hz = 200.0;                            ///< (0, 10000]
  double gyroscope_noise_rad_s_sqrt_hz = 1.6968e-4;  ///< white noise density, >= 0
  double gyroscope_walk_rad_s2_sqrt_hz = 1.9393e-5;  ///< of the bias's random walk, >= 0
  double accelerometer_noise_m_s2_sqrt_hz = 2.0e-3;  ///< white noise density, >= 0
  double accelerometer_walk_m_s3_sqrt_hz = 3.0e-3;   ///< of the bias's random walk, >= 0

  /// Measures without error.
  [[nodiscard]] static ImuModel ideal(double rate_hz = 200.0);
  /// Errors: kInvalidArgument naming field, value and limit.
  [[nodiscard]] Status validate() const;
};

/// One sample, body axes (forward-right-down).
struct ImuReading {
  std::int64_t t_ns = 0;  ///< the middle of the interval it is the mean of
  Eigen::Vector3d angular_rate_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force_m_s2 = Eigen::Vector3d::Zero();  ///< at rest: gravity upwards
  /// Errors contained in the sample that wander: the truth a filter should find.
  Eigen::Vector3d gyroscope_bias_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accelerometer_bias_m_s2 = Eigen::Vector3d::Zero();
};

/// Samples at k / rate from 0 to the flight's end or `end_ns`, whichever is first.
///
/// Each sample is the mean over its interval [t - T/2, t + T/2] (the first and the last: the half
/// of it that was flown), so that summing them up gives the attitude back exactly and the velocity
/// to the second order in T:
///   omega = log(R(t - T/2)^T R(t + T/2)) / T,   f = R(t)^T ((v(t + T/2) - v(t - T/2)) / T - g),
/// R = R_world_body. The world frame counts as inertial: without the earth's rotation (15 deg/h,
/// within the noise of such a unit), with gravity constant and along -up. White noise of density s
/// has the standard deviation s / sqrt(T) in a sample, a bias of walk density w grows by
/// w sqrt(T) a sample (Woodman 2007, UCAM-CL-TR-696, section 3.2).
///
/// @param flight        a truth source that has not been asked for a later time
/// @param gravity_m_s2  its size, > 0
/// @param keep_going    asked now and then; false cancels; may be empty
/// Errors: as ImuModel::validate; kCancelled; whatever the flight says before its end.
[[nodiscard]] Result<std::vector<ImuReading>> synthesize_imu(
    TruthSource& flight,
    std::int64_t end_ns,
    const ImuModel& model,
    double gravity_m_s2,
    std::uint64_t seed,
    const std::function<bool()>& keep_going = {});

}  // namespace overfly::flight
