#include "core/sensors/measured_samples.hpp"

#include <cmath>
#include <limits>

namespace overfly {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kIndicatedDensity = 1.225;  // [kg/m^3]

bool is_within(const Eigen::Vector3d& value, double limit) {
  return value.allFinite() && value.cwiseAbs().maxCoeff() <= limit;
}

}  // namespace

bool add_measured(SensorSamples& to, const ImuSample& sample) {
  constexpr double kMaxForceMS2 = 10'000.0;
  constexpr double kMaxRateRadS = 1000.0;
  if (!is_within(sample.acceleration_m_s2, kMaxForceMS2) ||
      !is_within(sample.angular_rate_rad_s, kMaxRateRadS)) {
    return false;
  }
  to.imu.push_back(sample);
  return true;
}

bool add_measured(SensorSamples& to, const BarometerSample& sample) {
  constexpr double kMaxPressurePa = 200'000.0;
  if (!(sample.pressure_pa > 0.0 && sample.pressure_pa <= kMaxPressurePa)) return false;
  const bool known = sample.temperature_k > 0.0 && std::isfinite(sample.temperature_k);
  to.barometer.push_back(
      {sample.t_ns, sample.pressure_pa, known ? sample.temperature_k : kUnknown});
  return true;
}

bool add_measured(SensorSamples& to, const AirspeedSample& sample) {
  constexpr double kMaxAirspeedMS = 1000.0;
  if (!std::isfinite(sample.differential_pressure_pa) ||
      !(std::abs(sample.indicated_airspeed_m_s) <= kMaxAirspeedMS)) {
    return false;
  }
  to.airspeed.push_back(sample);
  return true;
}

bool add_measured(SensorSamples& to, const MagnetometerSample& sample) {
  constexpr double kMaxFieldUt = 10'000.0;
  if (!is_within(sample.field_ut, kMaxFieldUt) || sample.field_ut.isZero(0.0)) return false;
  to.magnetometer.push_back(sample);
  return true;
}

bool add_measured(SensorSamples& to, const RangeSample& sample) {
  if (!(sample.range_m >= 0.0)) return false;
  to.range.push_back(sample);
  return true;
}

bool add_measured(SensorSamples& to, const GpsSample& sample) {
  const Geodetic& place = sample.place;
  constexpr double kHalfTurn = EIGEN_PI;
  const bool on_earth = std::abs(place.lat_rad) <= kHalfTurn / 2.0 &&
                        std::abs(place.lon_rad) <= kHalfTurn &&
                        std::isfinite(place.alt_ellipsoid_m);
  const bool fix = sample.fix != GpsFixType::kNone && on_earth;
  to.gps.push_back(fix ? sample : gps_without_fix(sample.t_ns, sample.delivered_ns));
  return true;
}

GpsSample gps_without_fix(std::int64_t t_ns, std::int64_t delivered_ns) {
  GpsSample sample;
  sample.t_ns = t_ns;
  sample.delivered_ns = delivered_ns;
  sample.fix = GpsFixType::kNone;
  sample.place = {kUnknown, kUnknown, kUnknown};
  sample.velocity_ned_m_s.setConstant(kUnknown);
  sample.horizontal_accuracy_m = kUnknown;
  sample.vertical_accuracy_m = kUnknown;
  sample.speed_accuracy_m_s = kUnknown;
  return sample;
}

AirspeedSample airspeed_of_pressure(std::int64_t t_ns, double pressure_pa) {
  const double speed_m_s = std::sqrt(2.0 * std::abs(pressure_pa) / kIndicatedDensity);
  return {t_ns, pressure_pa, std::copysign(speed_m_s, pressure_pa)};
}

AirspeedSample airspeed_of_speed(std::int64_t t_ns, double indicated_m_s) {
  const double pressure_pa = 0.5 * kIndicatedDensity * indicated_m_s * indicated_m_s;
  return {t_ns, std::copysign(pressure_pa, indicated_m_s), indicated_m_s};
}

}  // namespace overfly
