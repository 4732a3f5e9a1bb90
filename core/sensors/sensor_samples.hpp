// Measurements of the sensors that an aircraft carries in addition to its cameras: simulated, or
// received from a live vehicle.
//
// Times are those of the run. "body" is forward-right-down. A value that a sensor does not give is
// not a number (NaN).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/earth/geodesy.hpp"

namespace overfly {

/// Angular rate and specific force, body axes.
struct ImuSample {
  std::int64_t t_ns = 0;  ///< the middle of the interval over which the unit averaged
  Eigen::Vector3d acceleration_m_s2 = Eigen::Vector3d::Zero();  ///< at rest: gravity upwards
  Eigen::Vector3d angular_rate_rad_s = Eigen::Vector3d::Zero();
  std::int64_t interval_ns = 0;  ///< the length of this interval; 0: not known
};

/// Static pressure and temperature of the air.
struct BarometerSample {
  std::int64_t t_ns = 0;
  double pressure_pa = 0.0;
  double temperature_k = 0.0;
};

enum class GpsFixType { kNone, k3d };

/// Answer of a satellite navigation receiver.
struct GpsSample {
  std::int64_t t_ns = 0;             ///< when it was measured
  std::int64_t delivered_ns = 0;     ///< when the receiver sent it; >= t_ns
  GpsFixType fix = GpsFixType::k3d;  ///< kNone: all that follows is NaN
  Geodetic place;
  Eigen::Vector3d velocity_ned_m_s = Eigen::Vector3d::Zero();
  double horizontal_accuracy_m = 0.0;  ///< standard deviation along each of north and east
  double vertical_accuracy_m = 0.0;    ///< standard deviation
  double speed_accuracy_m_s = 0.0;     ///< standard deviation along each axis
};

/// Of a Pitot tube.
struct AirspeedSample {
  std::int64_t t_ns = 0;
  double differential_pressure_pa = 0.0;  ///< total minus static; noise may make it negative
  /// The airspeed that gives this pressure in air of 1.225 kg/m^3, with the pressure's sign.
  double indicated_airspeed_m_s = 0.0;
};

/// Magnetic flux density, body axes.
struct MagnetometerSample {
  std::int64_t t_ns = 0;
  Eigen::Vector3d field_ut = Eigen::Vector3d::Zero();
};

/// Distance along the sensor's beam to the ground, of a laser or radar altimeter.
struct RangeSample {
  std::int64_t t_ns = 0;
  double range_m = 0.0;  ///< +infinity: no echo within the sensor's limits
};

/// When a sample is available: not before the end of the interval that it was averaged over, or
/// before the receiver sent it.
template <typename Sample>
[[nodiscard]] std::int64_t available_ns(const Sample& sample) {
  return sample.t_ns;
}
[[nodiscard]] inline std::int64_t available_ns(const ImuSample& sample) {
  return sample.t_ns + sample.interval_ns / 2;
}
[[nodiscard]] inline std::int64_t available_ns(const GpsSample& sample) {
  return sample.delivered_ns;
}

/// Samples of one stretch of time, each list ordered by the time at which they were available.
struct SensorSamples {
  std::vector<ImuSample> imu;
  std::vector<BarometerSample> barometer;
  std::vector<GpsSample> gps;
  std::vector<AirspeedSample> airspeed;
  std::vector<MagnetometerSample> magnetometer;
  std::vector<RangeSample> range;

  [[nodiscard]] bool empty() const {
    return imu.empty() && barometer.empty() && gps.empty() && airspeed.empty() &&
           magnetometer.empty() && range.empty();
  }
};

/// Moves the samples behind those already there.
void append(SensorSamples& to, SensorSamples&& from);
/// When the first of them was available; empty without samples.
[[nodiscard]] std::optional<std::int64_t> first_available_ns(const SensorSamples& samples);
/// Removes the samples that were available at a time.
void drop_available_at(SensorSamples& samples, std::int64_t t_ns);
/// Removes the samples that were available more than `age_ns` before the newest one.
void drop_older_than(SensorSamples& samples, std::int64_t age_ns);

}  // namespace overfly
