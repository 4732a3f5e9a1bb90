#include "flight/mavlink/sensor_messages.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "core/motion/pose.hpp"
#include "core/sensors/measured_samples.hpp"
#include "core/time.hpp"
#include "flight/mavlink/autopilots.hpp"
#include "flight/mavlink/payload.hpp"

namespace overfly::flight::mavlink {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kUtPerGauss = 100.0;
constexpr double kPaPerHpa = 100.0;
constexpr double kZeroCelsiusK = 273.15;

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

void add_imu(std::int64_t t_ns, const Imu& imu, SensorSamples& samples) {
  (void)add_measured(samples, ImuSample{t_ns, imu.acceleration_m_s2, imu.rate_rad_s});
}

void add_field(std::int64_t t_ns, const Eigen::Vector3d& field_ut, SensorSamples& samples) {
  (void)add_measured(samples, MagnetometerSample{t_ns, field_ut});
}

/// @param temperature_k  NaN: unknown
void add_pressure(std::int64_t t_ns, double pa, double temperature_k, SensorSamples& samples) {
  (void)add_measured(samples, BarometerSample{t_ns, pa, temperature_k});
}

/// Vehicles send no airspeed below 0.
void add_airspeed(const AirspeedSample& sample, SensorSamples& samples) {
  if (sample.indicated_airspeed_m_s >= 0.0) (void)add_measured(samples, sample);
}

void add_range(std::int64_t t_ns, double range_m, SensorSamples& samples) {
  (void)add_measured(samples, RangeSample{t_ns, range_m});
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
  GpsSample sample = gps_without_fix(context.latest_ns, context.latest_ns);
  if (payload.at<std::uint8_t>(layout.fix_type) < 3) return sample;
  // A receiver that has stopped is sent again and again with its old time. Others state UTC.
  const std::int64_t stated_ns = us_at(payload, 0);
  const bool of_vehicle = stated_ns > 0 && stated_ns <= context.latest_ns + kNsPerS;
  if (of_vehicle) sample.t_ns = std::min(stated_ns, context.latest_ns);
  sample.fix = GpsFixType::k3d;
  const double lat_deg = 1e-7 * payload.at<std::int32_t>(8);
  const double lon_deg = 1e-7 * payload.at<std::int32_t>(12);
  const double alt_msl_m = 1e-3 * payload.at<std::int32_t>(16);
  sample.place = geodetic_from_deg(lat_deg, lon_deg, alt_msl_m + context.geoid_separation_m);
  constexpr std::uint16_t kNoValue = 0xFFFF;
  const auto speed = payload.at<std::uint16_t>(layout.speed);
  const auto course = payload.at<std::uint16_t>(layout.course);
  if (speed != kNoValue && course != kNoValue) {
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
          {context.latest_ns, kPaPerHpa * payload.at<float>(4), decode_airspeed_m_s(frame)},
          samples);
    case MessageId::kVfrHud:
      return add_airspeed(airspeed_of_speed(context.latest_ns, decode_vfr_hud(frame).airspeed_m_s),
                          samples);
    case MessageId::kGpsRawInt:
      (void)add_measured(samples, gps_sample(frame, kFirstReceiver, context));
      return;
    case MessageId::kGps2Raw:
      (void)add_measured(samples, gps_sample(frame, kSecondReceiver, context));
      return;
    case MessageId::kDistanceSensor:
      return add_distance(frame, context, samples);
    case MessageId::kRangefinder:
      return add_range(context.latest_ns, payload.at<float>(0), samples);
    default:
      return;
  }
}

}  // namespace

bool may_have_samples(MessageId id) {
  return std::any_of(std::begin(kSensorMessages),
                     std::end(kSensorMessages),
                     [id](const SensorMessage& message) { return message.id == id; });
}

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
