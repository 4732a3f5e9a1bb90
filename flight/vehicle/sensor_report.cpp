#include "flight/vehicle/sensor_report.hpp"

#include <algorithm>
#include <cmath>

#include "flight/dynamics/environment.hpp"
#include "flight/vehicle/report_fields.hpp"

namespace overfly::vehicle {
namespace {

using flight::mavlink::MessageId;
using flight::mavlink::PayloadWriter;

constexpr double kPaOfHpa = 100.0;
constexpr double kFreezingK = 273.15;
constexpr double kMilliGravityMS2 = 1e-3 * dynamics::kStandardGravityMS2;
constexpr double kUtOfGauss = 100.0;

dynamics::StandardAir air_around(const VehicleReport& report) {
  return dynamics::standard_air(
      report.frame.geodetic_from_world(report.state.position_world_m).alt_ellipsoid_m);
}

double dynamic_pressure_pa(const VehicleReport& report) {
  const double speed = report.state.airspeed_m_s;
  return 0.5 * air_around(report).density_kg_m3 * speed * speed;
}

Eigen::Vector3d field_body_ut(const VehicleReport& report) {
  return R_ned_body(report).conjugate() * report.field_ned_ut;
}

void put_whole(PayloadWriter& payload, std::size_t at, const Eigen::Vector3d& value, double unit) {
  for (int i = 0; i < 3; ++i) {
    payload.put(at + 2 * static_cast<std::size_t>(i), field<std::int16_t>(value[i] / unit));
  }
}

/// RAW_IMU in the units that ArduPilot sends: thousandths of gravity, mrad/s, milligauss.
PayloadWriter raw_imu(const VehicleReport& report) {
  PayloadWriter payload(29);
  payload.put(0, static_cast<std::uint64_t>(report.boot_ns / 1000));
  put_whole(payload, 8, report.state.specific_force_body_m_s2, kMilliGravityMS2);
  put_whole(payload, 14, report.state.omega_body_rad_s, 1e-3);
  put_whole(payload, 20, field_body_ut(report), 1e-3 * kUtOfGauss);
  return payload;
}

PayloadWriter highres_imu(const VehicleReport& report) {
  constexpr std::uint16_t kAllFields = 0x1FFF;
  const dynamics::StandardAir air = air_around(report);
  PayloadWriter payload(63);
  payload.put(0, static_cast<std::uint64_t>(report.boot_ns / 1000));
  put_vector(payload, 8, report.state.specific_force_body_m_s2.cast<float>());
  put_rates(payload, 20, report);
  put_vector(payload, 32, (field_body_ut(report) / kUtOfGauss).cast<float>());
  const double height_m =
      report.frame.geodetic_from_world(report.state.position_world_m).alt_ellipsoid_m;
  return payload.put(44, static_cast<float>(air.pressure_pa / kPaOfHpa))
      .put(48, static_cast<float>(dynamic_pressure_pa(report) / kPaOfHpa))
      .put(52, static_cast<float>(height_m))
      .put(56, static_cast<float>(air.temperature_k - kFreezingK))
      .put(60, kAllFields);
}

PayloadWriter scaled_pressure(const VehicleReport& report) {
  const dynamics::StandardAir air = air_around(report);
  return PayloadWriter(16)
      .put(0, boot_ms(report))
      .put(4, static_cast<float>(air.pressure_pa / kPaOfHpa))
      .put(8, static_cast<float>(dynamic_pressure_pa(report) / kPaOfHpa))
      .put(12, field<std::int16_t>(100.0 * (air.temperature_k - kFreezingK)));
}

PayloadWriter airspeed(const VehicleReport& report) {
  constexpr double kSeaLevelDensity = 1.225;
  const double pressure_pa = dynamic_pressure_pa(report);
  const double celsius = air_around(report).temperature_k - kFreezingK;
  return PayloadWriter(12)
      .put(0, static_cast<float>(std::sqrt(2.0 * pressure_pa / kSeaLevelDensity)))
      .put(4, static_cast<float>(pressure_pa / kPaOfHpa))
      .put(8, field<std::int16_t>(100.0 * celsius));
}

/// Of a laser altimeter along the body's z axis over flat ground, 0.2 to 120 m.
PayloadWriter ground_distance(const VehicleReport& report) {
  constexpr std::uint16_t kMinCm = 20;
  constexpr std::uint16_t kMaxCm = 12000;
  constexpr std::uint8_t kLaser = 0;
  constexpr std::uint8_t kLooksDown = 25;  // MAV_SENSOR_ROTATION_PITCH_270
  constexpr std::uint8_t kUnknownVariance = 255;
  const double down = (R_ned_body(report) * Eigen::Vector3d::UnitZ()).z();
  const double distance_cm =
      down > 0.0 ? 100.0 * report.state.position_world_m.z() / down : double{kMaxCm};
  return PayloadWriter(39)
      .put(0, boot_ms(report))
      .put(4, kMinCm)
      .put(6, kMaxCm)
      .put(8, std::min(kMaxCm, field<std::uint16_t>(distance_cm)))
      .put(10, kLaser)
      .put(12, kLooksDown)
      .put(13, kUnknownVariance);
}

}  // namespace

std::optional<PayloadWriter> sensor_payload_of(MessageId id, const VehicleReport& report) {
  switch (id) {
    case MessageId::kRawImu:
      return raw_imu(report);
    case MessageId::kHighresImu:
      return highres_imu(report);
    case MessageId::kScaledPressure:
      return scaled_pressure(report);
    case MessageId::kAirspeed:
      return airspeed(report);
    case MessageId::kDistanceSensor:
      return ground_distance(report);
    default:
      return std::nullopt;
  }
}

}  // namespace overfly::vehicle
