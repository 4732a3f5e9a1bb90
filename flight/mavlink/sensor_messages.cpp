#include "flight/mavlink/sensor_messages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/motion/pose.hpp"
#include "core/time.hpp"
#include "flight/mavlink/messages.hpp"
#include "flight/mavlink/payload.hpp"

namespace overfly::flight::mavlink {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kUtPerGauss = 100.0;
constexpr double kPaPerHpa = 100.0;
constexpr double kZeroCelsiusK = 273.15;
constexpr double kSeaLevelDensity = 1.225;  // of indicated airspeeds [kg/m^3]

/// The time of a message, if it is one of the vehicle's clock.
std::int64_t sample_time_ns(std::int64_t stated_ns, const SensorContext& context) {
  const bool plausible = stated_ns > 0 && stated_ns >= context.latest_ns - 2 * kNsPerS &&
                         stated_ns <= context.latest_ns + kNsPerS;
  return plausible ? stated_ns : context.latest_ns;
}

std::int64_t us_at(const PayloadReader& payload, std::size_t offset) {
  const auto time_us = payload.at<std::uint64_t>(offset);
  constexpr std::uint64_t kLatestUs = 1ULL << 52U;  // its nanoseconds fit
  return time_us < kLatestUs ? static_cast<std::int64_t>(time_us * 1000) : 0;
}

std::int64_t ms_at(const PayloadReader& payload, std::size_t offset) {
  return std::int64_t{payload.at<std::uint32_t>(offset)} * 1'000'000;
}

bool is_measurable(const Eigen::Vector3d& value, double limit) {
  return value.allFinite() && value.cwiseAbs().maxCoeff() <= limit;
}

void add_imu(std::int64_t t_ns, const Imu& imu, SensorSamples& samples) {
  constexpr double kMaxAccelerationMS2 = 10'000.0;
  constexpr double kMaxRateRadS = 1000.0;
  if (!is_measurable(imu.acceleration_m_s2, kMaxAccelerationMS2)) return;
  if (!is_measurable(imu.rate_rad_s, kMaxRateRadS)) return;
  samples.imu.push_back({t_ns, imu.acceleration_m_s2, imu.rate_rad_s});
}

void add_field(std::int64_t t_ns, const Eigen::Vector3d& field_ut, SensorSamples& samples) {
  constexpr double kMaxFieldUt = 10'000.0;
  if (!is_measurable(field_ut, kMaxFieldUt) || field_ut.isZero(0.0)) return;
  samples.magnetometer.push_back({t_ns, field_ut});
}

/// @param temperature_k  NaN: unknown
void add_pressure(std::int64_t t_ns, double pa, double temperature_k, SensorSamples& samples) {
  constexpr double kMaxPressurePa = 200'000.0;
  if (!(pa > 0.0 && pa <= kMaxPressurePa)) return;
  samples.barometer.push_back({t_ns, pa, temperature_k > 0.0 ? temperature_k : kNotANumber});
}

void add_airspeed(std::int64_t t_ns, double pa, double airspeed_m_s, SensorSamples& samples) {
  constexpr double kMaxAirspeedMS = 1000.0;
  if (!std::isfinite(pa) || !(airspeed_m_s >= 0.0 && airspeed_m_s <= kMaxAirspeedMS)) return;
  samples.airspeed.push_back({t_ns, pa, airspeed_m_s});
}

void add_range(std::int64_t t_ns, double range_m, SensorSamples& samples) {
  if (range_m >= 0.0) samples.range.push_back({t_ns, range_m});
}

/// Milligauss in three signed fields.
Eigen::Vector3d field_at(const PayloadReader& payload, std::size_t offset) {
  return 1e-3 * kUtPerGauss *
         Eigen::Vector3d(payload.at<std::int16_t>(offset),
                         payload.at<std::int16_t>(offset + 2),
                         payload.at<std::int16_t>(offset + 4));
}

void add_high_resolution(const Frame& frame, const SensorContext& context, SensorSamples& samples) {
  const PayloadReader payload(frame.payload);
  // HIGHRES_IMU_UPDATED_FLAGS: acceleration, rate, magnetic field, pressure, temperature.
  constexpr std::uint16_t kInertial = 0x003F;
  constexpr std::uint16_t kMagnetic = 0x01C0;
  constexpr std::uint16_t kPressure = 0x0200;
  constexpr std::uint16_t kTemperature = 0x1000;
  const auto updated = payload.at<std::uint16_t>(60);
  const auto has = [updated](std::uint16_t fields) { return (updated & fields) == fields; };
  const std::int64_t t_ns = sample_time_ns(us_at(payload, 0), context);
  if (has(kInertial)) add_imu(t_ns, decode_imu(frame), samples);
  if (has(kMagnetic)) {
    const Eigen::Vector3d gauss(
        payload.at<float>(32), payload.at<float>(36), payload.at<float>(40));
    add_field(t_ns, kUtPerGauss * gauss, samples);
  }
  if (!has(kPressure)) return;
  const double celsius = has(kTemperature) ? payload.at<float>(56) : kNotANumber;
  add_pressure(t_ns, kPaPerHpa * payload.at<float>(44), celsius + kZeroCelsiusK, samples);
}

/// Where the fields of a receiver's message are.
struct GpsLayout {
  std::size_t speed;
  std::size_t course;
  std::size_t fix_type;
  std::size_t accuracies;  ///< of place, height, speed
};
constexpr GpsLayout kFirstReceiver{24, 26, 28, 34};
constexpr GpsLayout kSecondReceiver{28, 30, 32, 41};

/// Millimetres; 0: not known.
double accuracy_at(const PayloadReader& payload, std::size_t offset) {
  const auto mm = payload.at<std::uint32_t>(offset);
  return mm == 0 ? kNotANumber : 1e-3 * mm;
}

GpsSample gps_sample(const Frame& frame, const GpsLayout& layout, const SensorContext& context) {
  const PayloadReader payload(frame.payload);
  GpsSample sample;
  sample.delivered_ns = context.latest_ns;
  // A receiver that has stopped is sent again and again with its old time. Others state UTC.
  const std::int64_t stated_ns = us_at(payload, 0);
  const bool of_vehicle = stated_ns > 0 && stated_ns <= context.latest_ns + kNsPerS;
  sample.t_ns = of_vehicle ? std::min(stated_ns, context.latest_ns) : context.latest_ns;
  sample.velocity_ned_m_s.setConstant(kNotANumber);
  const double lat_deg = 1e-7 * payload.at<std::int32_t>(8);
  const double lon_deg = 1e-7 * payload.at<std::int32_t>(12);
  const bool on_earth = std::abs(lat_deg) <= 90.0 && std::abs(lon_deg) <= 180.0;
  if (payload.at<std::uint8_t>(layout.fix_type) < 3 || !on_earth) {
    sample.t_ns = sample.delivered_ns;
    sample.fix = GpsFixType::kNone;
    sample.place = {kNotANumber, kNotANumber, kNotANumber};
    sample.horizontal_accuracy_m = kNotANumber;
    sample.vertical_accuracy_m = kNotANumber;
    sample.speed_accuracy_m_s = kNotANumber;
    return sample;
  }
  const double alt_msl_m = 1e-3 * payload.at<std::int32_t>(16);
  sample.place = geodetic_from_deg(lat_deg, lon_deg, alt_msl_m + context.geoid_separation_m);
  constexpr std::uint16_t kUnknown = 0xFFFF;
  const auto speed = payload.at<std::uint16_t>(layout.speed);
  const auto course = payload.at<std::uint16_t>(layout.course);
  if (speed != kUnknown && course != kUnknown) {
    const double course_rad = rad_from_deg(0.01 * course);
    sample.velocity_ned_m_s.x() = 0.01 * speed * std::cos(course_rad);
    sample.velocity_ned_m_s.y() = 0.01 * speed * std::sin(course_rad);
  }
  sample.horizontal_accuracy_m = accuracy_at(payload, layout.accuracies);
  sample.vertical_accuracy_m = accuracy_at(payload, layout.accuracies + 4);
  sample.speed_accuracy_m_s = accuracy_at(payload, layout.accuracies + 8);
  return sample;
}

void add_distance(const Frame& frame, const SensorContext& context, SensorSamples& samples) {
  const PayloadReader payload(frame.payload);
  constexpr std::uint8_t kLooksDown = 25;  // MAV_SENSOR_ROTATION_PITCH_270
  constexpr std::uint8_t kNoEcho = 1;      // signal_quality
  if (payload.at<std::uint8_t>(12) != kLooksDown) return;
  const auto max_cm = payload.at<std::uint16_t>(6);
  const auto distance_cm = payload.at<std::uint16_t>(8);
  const bool echo = payload.at<std::uint8_t>(38) != kNoEcho && distance_cm < max_cm;
  add_range(sample_time_ns(ms_at(payload, 0), context),
            echo ? 0.01 * distance_cm : std::numeric_limits<double>::infinity(),
            samples);
}

/// Message of a sensor, its preference, and the offset of the sensor's number; 0: it has none.
struct SensorMessage {
  MessageId id;
  std::size_t number_at;
};
/// By preference.
constexpr SensorMessage kSensorMessages[] = {
    {MessageId::kHighresImu, 62},
    {MessageId::kRawImu, 26},
    {MessageId::kScaledImu, 0},
    {MessageId::kScaledImu2, 0},
    {MessageId::kScaledImu3, 0},
    {MessageId::kScaledPressure, 0},
    {MessageId::kAirspeed, 10},
    {MessageId::kVfrHud, 0},
    {MessageId::kGpsRawInt, 0},
    {MessageId::kGps2Raw, 0},
    {MessageId::kDistanceSensor, 11},
    {MessageId::kRangefinder, 0},
};

void add_samples(const Frame& frame, const SensorContext& context, SensorSamples& samples) {
  const PayloadReader payload(frame.payload);
  switch (static_cast<MessageId>(frame.message_id)) {
    case MessageId::kHighresImu:
      return add_high_resolution(frame, context, samples);
    case MessageId::kRawImu: {
      constexpr std::uint8_t kArduPilot = 3;
      if (context.autopilot != kArduPilot) return;
      const std::int64_t t_ns = sample_time_ns(us_at(payload, 0), context);
      add_imu(t_ns, decode_imu(frame), samples);
      return add_field(t_ns, field_at(payload, 20), samples);
    }
    case MessageId::kScaledImu:
    case MessageId::kScaledImu2:
    case MessageId::kScaledImu3: {
      const std::int64_t t_ns = sample_time_ns(ms_at(payload, 0), context);
      add_imu(t_ns, decode_imu(frame), samples);
      return add_field(t_ns, field_at(payload, 16), samples);
    }
    case MessageId::kScaledPressure:
      return add_pressure(sample_time_ns(ms_at(payload, 0), context),
                          kPaPerHpa * payload.at<float>(4),
                          0.01 * payload.at<std::int16_t>(12) + kZeroCelsiusK,
                          samples);
    case MessageId::kAirspeed:
      return add_airspeed(
          context.latest_ns, kPaPerHpa * payload.at<float>(4), decode_airspeed_m_s(frame), samples);
    case MessageId::kVfrHud: {
      const double airspeed_m_s = decode_vfr_hud(frame).airspeed_m_s;
      return add_airspeed(context.latest_ns,
                          0.5 * kSeaLevelDensity * airspeed_m_s * airspeed_m_s,
                          airspeed_m_s,
                          samples);
    }
    case MessageId::kGpsRawInt:
      return samples.gps.push_back(gps_sample(frame, kFirstReceiver, context));
    case MessageId::kGps2Raw:
      return samples.gps.push_back(gps_sample(frame, kSecondReceiver, context));
    case MessageId::kDistanceSensor:
      return add_distance(frame, context, samples);
    case MessageId::kRangefinder:
      return add_range(context.latest_ns, payload.at<float>(0), samples);
    default:
      return;
  }
}

}  // namespace

std::optional<MessageSamples> sensor_samples_of(const Frame& frame, const SensorContext& context) {
  int preference = 0;
  for (const SensorMessage& message : kSensorMessages) {
    constexpr int kNumbers = 256;
    preference += kNumbers;
    if (static_cast<std::uint32_t>(message.id) != frame.message_id) continue;
    MessageSamples measured;
    measured.preference = preference;
    if (message.number_at != 0) {
      measured.preference += PayloadReader(frame.payload).at<std::uint8_t>(message.number_at);
    }
    add_samples(frame, context, measured.samples);
    if (measured.samples.empty()) return std::nullopt;
    return measured;
  }
  return std::nullopt;
}

}  // namespace overfly::flight::mavlink
