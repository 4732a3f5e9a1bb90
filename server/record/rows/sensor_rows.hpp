// Rows of the sensor files in a run folder (docs/RUN_FOLDER.md). Private to server/record.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/motion/pose.hpp"
#include "core/sensors/sensor_samples.hpp"

namespace overfly::server {

/// What a row of one sensor's file holds. Each specialisation has
///   kFile, kHeader   name of the file and its first line
///   kValues          number of values after the time
///   kSamples         the list of SensorSamples
///   values(sample)   the values, in the header's order and units
///   sample(t, v)     the inverse
template <typename Sample>
struct SensorRow;

inline constexpr double kRowDeg = 180.0 / kPi;

/// A duration outside a day is no sensor's: 0. This also keeps the conversion defined.
[[nodiscard]] inline std::int64_t duration_in_row_ns(double value) {
  constexpr double kDayNs = 86400e9;
  return value >= 0.0 && value <= kDayNs ? static_cast<std::int64_t>(value) : 0;
}

template <>
struct SensorRow<ImuSample> {
  static constexpr const char* kFile = "imu.csv";
  static constexpr const char* kHeader =
      "t_ns,wx_rad_s,wy_rad_s,wz_rad_s,fx_m_s2,fy_m_s2,fz_m_s2,interval_ns";
  static constexpr std::size_t kValues = 7;
  static constexpr auto kSamples = &SensorSamples::imu;
  static std::array<double, kValues> values(const ImuSample& s) {
    const Eigen::Vector3d& w = s.angular_rate_rad_s;
    const Eigen::Vector3d& f = s.acceleration_m_s2;
    return {w.x(), w.y(), w.z(), f.x(), f.y(), f.z(), static_cast<double>(s.interval_ns)};
  }
  static ImuSample sample(std::int64_t t_ns, const std::array<double, kValues>& v) {
    return {t_ns, {v[3], v[4], v[5]}, {v[0], v[1], v[2]}, duration_in_row_ns(v[6])};
  }
};

template <>
struct SensorRow<BarometerSample> {
  static constexpr const char* kFile = "barometer.csv";
  static constexpr const char* kHeader = "t_ns,pressure_pa,temperature_k";
  static constexpr std::size_t kValues = 2;
  static constexpr auto kSamples = &SensorSamples::barometer;
  static std::array<double, kValues> values(const BarometerSample& s) {
    return {s.pressure_pa, s.temperature_k};
  }
  static BarometerSample sample(std::int64_t t_ns, const std::array<double, kValues>& v) {
    return {t_ns, v[0], v[1]};
  }
};

/// The latency is a whole number of nanoseconds below 2^53: a double holds it exactly.
template <>
struct SensorRow<GpsSample> {
  static constexpr const char* kFile = "gps.csv";
  static constexpr const char* kHeader =
      "t_ns,latency_ns,fix,lat_deg,lon_deg,alt_ellipsoid_m,v_north_m_s,v_east_m_s,v_down_m_s,"
      "horizontal_accuracy_m,vertical_accuracy_m,speed_accuracy_m_s";
  static constexpr std::size_t kValues = 11;
  static constexpr auto kSamples = &SensorSamples::gps;
  static std::array<double, kValues> values(const GpsSample& s) {
    const Eigen::Vector3d& v = s.velocity_ned_m_s;
    return {static_cast<double>(s.delivered_ns - s.t_ns),
            s.fix == GpsFixType::k3d ? 3.0 : 0.0,
            s.place.lat_rad * kRowDeg,
            s.place.lon_rad * kRowDeg,
            s.place.alt_ellipsoid_m,
            v.x(),
            v.y(),
            v.z(),
            s.horizontal_accuracy_m,
            s.vertical_accuracy_m,
            s.speed_accuracy_m_s};
  }
  static GpsSample sample(std::int64_t t_ns, const std::array<double, kValues>& v) {
    GpsSample s;
    s.t_ns = t_ns;
    s.delivered_ns = t_ns + duration_in_row_ns(v[0]);
    s.fix = v[1] == 3.0 ? GpsFixType::k3d : GpsFixType::kNone;
    s.place = {v[2] / kRowDeg, v[3] / kRowDeg, v[4]};
    s.velocity_ned_m_s = {v[5], v[6], v[7]};
    s.horizontal_accuracy_m = v[8];
    s.vertical_accuracy_m = v[9];
    s.speed_accuracy_m_s = v[10];
    return s;
  }
};

template <>
struct SensorRow<AirspeedSample> {
  static constexpr const char* kFile = "airspeed.csv";
  static constexpr const char* kHeader = "t_ns,differential_pressure_pa,indicated_airspeed_m_s";
  static constexpr std::size_t kValues = 2;
  static constexpr auto kSamples = &SensorSamples::airspeed;
  static std::array<double, kValues> values(const AirspeedSample& s) {
    return {s.differential_pressure_pa, s.indicated_airspeed_m_s};
  }
  static AirspeedSample sample(std::int64_t t_ns, const std::array<double, kValues>& v) {
    return {t_ns, v[0], v[1]};
  }
};

template <>
struct SensorRow<MagnetometerSample> {
  static constexpr const char* kFile = "magnetometer.csv";
  static constexpr const char* kHeader = "t_ns,x_ut,y_ut,z_ut";
  static constexpr std::size_t kValues = 3;
  static constexpr auto kSamples = &SensorSamples::magnetometer;
  static std::array<double, kValues> values(const MagnetometerSample& s) {
    return {s.field_ut.x(), s.field_ut.y(), s.field_ut.z()};
  }
  static MagnetometerSample sample(std::int64_t t_ns, const std::array<double, kValues>& v) {
    return {t_ns, {v[0], v[1], v[2]}};
  }
};

template <>
struct SensorRow<RangeSample> {
  static constexpr const char* kFile = "range.csv";
  static constexpr const char* kHeader = "t_ns,range_m";
  static constexpr std::size_t kValues = 1;
  static constexpr auto kSamples = &SensorSamples::range;
  static std::array<double, kValues> values(const RangeSample& s) { return {s.range_m}; }
  static RangeSample sample(std::int64_t t_ns, const std::array<double, kValues>& v) {
    return {t_ns, v[0]};
  }
};

}  // namespace overfly::server
