// Error models of the sensors that an aircraft carries in addition to its cameras.
//
// The values are standard deviations, per axis and sample unless said otherwise. A "drift" is a
// first-order Gauss-Markov process: it has this standard deviation at all times, and forgets its
// value with the time constant drift_time_s.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

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

/// A static port with a pressure sensor. The noise is that of the MS5611-01BA (data sheet, best
/// resolution).
struct BarometerModel {
  double rate_hz = 25.0;
  double noise_pa = 1.2;
  double drift_pa = 30.0;  ///< of the sensor and of the weather's pressure
  double temperature_noise_k = 0.1;
  double temperature_drift_k = 2.0;
  double drift_time_s = 600.0;
};

/// A satellite receiver. Position errors as in Beard and McLain 2012, "Small Unmanned Aircraft",
/// section 7.5: a slow Gauss-Markov process and white noise.
struct GpsModel {
  double rate_hz = 5.0;
  double delay_s = 0.1;  ///< from the measurement to its delivery
  double horizontal_drift_m = 4.7;
  double vertical_drift_m = 9.2;
  double drift_time_s = 1100.0;
  double horizontal_noise_m = 0.4;
  double vertical_noise_m = 0.7;
  double velocity_noise_m_s = 0.05;
};

/// A Pitot tube with a differential pressure sensor. The noise is that of Beard and McLain 2012,
/// section 7.3.2 (MPXV5004G).
struct AirspeedModel {
  double rate_hz = 20.0;
  double noise_pa = 2.0;
  double drift_pa = 5.0;
  double drift_time_s = 600.0;
};

/// A magnetometer. The bias, drawn once for a flight, is what the aircraft's own iron leaves after
/// a calibration.
struct MagnetometerModel {
  double rate_hz = 50.0;
  double noise_ut = 0.2;
  double bias_ut = 0.5;
};

/// A laser or radar altimeter that looks along the body's z axis (down in level flight).
struct RangeModel {
  double rate_hz = 20.0;
  double noise_m = 0.05;
  double min_m = 0.2;
  double max_m = 120.0;
};

/// A value of a model by its name in scenarios and messages, with its limits.
template <typename Model>
struct ModelField {
  const char* name;
  double Model::*value;
  double min;
  double max;
};

/// The values of a model in the order in which they are checked.
template <typename Model>
[[nodiscard]] std::span<const ModelField<Model>> fields_of();
template <>
std::span<const ModelField<ImuModel>> fields_of();
template <>
std::span<const ModelField<BarometerModel>> fields_of();
template <>
std::span<const ModelField<GpsModel>> fields_of();
template <>
std::span<const ModelField<AirspeedModel>> fields_of();
template <>
std::span<const ModelField<MagnetometerModel>> fields_of();
template <>
std::span<const ModelField<RangeModel>> fields_of();

/// The sensors that are fitted.
struct SensorModels {
  std::optional<ImuModel> imu;
  std::optional<BarometerModel> barometer;
  std::optional<GpsModel> gps;
  std::optional<AirspeedModel> airspeed;
  std::optional<MagnetometerModel> magnetometer;
  std::optional<RangeModel> range;

  [[nodiscard]] bool none() const {
    return !imu && !barometer && !gps && !airspeed && !magnetometer && !range;
  }
  /// Calls `visit(name, model)` for each of the optional models.
  template <typename Visit>
  void with_each(const Visit& visit) {
    with_each_of(*this, visit);
  }
  template <typename Visit>
  void with_each(const Visit& visit) const {
    with_each_of(*this, visit);
  }
  /// The limits of fields_of, and min_m < max_m of a range.
  /// Errors: kInvalidArgument naming field, value and limit.
  [[nodiscard]] Status validate() const;

 private:
  template <typename Models, typename Visit>
  static void with_each_of(Models& models, const Visit& visit) {
    visit("imu", models.imu);
    visit("barometer", models.barometer);
    visit("gps", models.gps);
    visit("airspeed", models.airspeed);
    visit("magnetometer", models.magnetometer);
    visit("range", models.range);
  }
};

}  // namespace overfly::flight
