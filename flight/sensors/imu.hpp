// Measurements of an inertial measurement unit at the origin of the aircraft's body frame.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/motion/truth_source.hpp"
#include "core/result.hpp"
#include "core/sensors/sensor_samples.hpp"
#include "core/time.hpp"
#include "flight/normal_noise.hpp"
#include "flight/sensors/sensor_models.hpp"

namespace overfly::flight {

/// One sample, and the bias that it contains (random walk): the ground truth for a filter.
struct ImuReading {
  ImuSample sample;
  Eigen::Vector3d gyroscope_bias_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accelerometer_bias_m_s2 = Eigen::Vector3d::Zero();
};

/// Noise and bias of an IMU, sample by sample. White noise of density s has the standard deviation
/// s / sqrt(T) per sample; a bias of walk density w grows by w sqrt(T) per sample (Woodman 2007,
/// UCAM-CL-TR-696, section 3.2). The same random numbers are drawn for all densities, so that the
/// bias of sample k follows only from the seed and the model.
class ImuErrors {
 public:
  ImuErrors(const ImuModel& model, std::uint64_t seed) : model_(model), noise_(seed) {}
  /// Adds the errors of the next sample.
  /// @param interval_s  T, over which it is the mean
  void apply(double interval_s, ImuReading& reading);

 private:
  Eigen::Vector3d draw();

  ImuModel model_;
  NormalNoise noise_;
  Eigen::Vector3d gyroscope_bias_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d accelerometer_bias_ = Eigen::Vector3d::Zero();
};

/// Measures a flight as it is flown: samples at k / rate from 0 on.
///
/// Each sample is the mean over its interval [t - T/2, t + T/2]; the first uses only the half that
/// was flown. Integrating the samples therefore reproduces the attitude exactly and the velocity to
/// second order in T:
///   omega = log(R(t - T/2)^T R(t + T/2)) / T,   f = R(t)^T ((v(t + T/2) - v(t - T/2)) / T - g),
/// R = R_world_body. The world frame is treated as inertial: the earth's rotation (15 deg/h, within
/// the noise of such a unit) is neglected, and gravity is constant and along -up.
class Imu {
 public:
  /// @pre the model is valid
  /// @param gravity_m_s2  magnitude of gravity, > 0
  Imu(const ImuModel& model, double gravity_m_s2, std::uint64_t seed);

  /// The next time at which the state is needed: the middle or the end of an interval.
  [[nodiscard]] std::int64_t next_ns() const { return frame_time_ns(step_, half_steps_); }
  /// Takes the state at next_ns(); at the end of an interval it returns the sample.
  std::optional<ImuReading> take(const AircraftState& state);
  /// The end of the flight: the mean over the part of the last interval that was flown. Empty if
  /// its middle was not reached.
  /// @param state  after the last taken one
  std::optional<ImuReading> take_end(const AircraftState& state);

 private:
  FrameRate half_steps_;  ///< twice the rate: the odd stamps lie between the samples
  double gravity_m_s2_;
  ImuErrors errors_;
  std::int64_t step_ = 0;
  AircraftState from_;  ///< the beginning of the interval
  AircraftState middle_;
};

/// The biases that samples of such an IMU contain.
/// @param samples  from the first of a flight on
/// Errors: kUnreadable naming the sample whose time is not that of the model.
[[nodiscard]] Result<std::vector<ImuReading>> with_biases(const std::vector<ImuSample>& samples,
                                                          const ImuModel& model,
                                                          std::uint64_t seed);

/// Measures a flight to its end or `end_ns`, whichever is first. The last sample uses only the half
/// of its interval that was flown.
/// @param flight        a truth source that has not been queried for a later time
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
