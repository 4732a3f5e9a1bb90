#include "flight/logs/lcm/lcm_messages.hpp"

#include <string>

#include "core/motion/pose.hpp"
#include "core/sensors/measured_samples.hpp"
#include "core/time.hpp"
#include "flight/logs/ned_attitude.hpp"

namespace overfly::flight::logs {
namespace {

constexpr LcmType kTimedTypes[] = {LcmType::kTruth,
                                   LcmType::kImage,
                                   LcmType::kPose,
                                   LcmType::kSimTime,
                                   LcmType::kDebug,
                                   LcmType::kWorldPose,
                                   LcmType::kImu,
                                   LcmType::kBarometer,
                                   LcmType::kGps,
                                   LcmType::kAirspeed,
                                   LcmType::kMagnetometer,
                                   LcmType::kRange};

// Offsets behind the fingerprint (8), utime (8), t_ns (8), stamp_ns (8) and frame (8).
constexpr std::size_t kTimeAt = 16;
constexpr std::size_t kTruthPositionAt = 40;
constexpr std::size_t kTruthOrientationAt = kTruthPositionAt + 3 * sizeof(double);
constexpr std::size_t kTruthBytes = kTruthOrientationAt + 4 * sizeof(double);

// Offset of the values of a sensor, behind the fingerprint (8), utime (8), t_ns (8), session (8)
// and sequence (8).
constexpr std::size_t kValuesAt = 40;

/// Bytes of a message of a sensor; 0: it is of another type.
std::size_t sensor_message_bytes(LcmType type) {
  switch (type) {
    case LcmType::kImu:
      return kValuesAt + 6 * sizeof(double);
    case LcmType::kBarometer:
    case LcmType::kAirspeed:
      return kValuesAt + 2 * sizeof(double);
    case LcmType::kGps:
      return kValuesAt + 9 + 9 * sizeof(double);  // delivered_ns and fix in front
    case LcmType::kMagnetometer:
      return kValuesAt + 3 * sizeof(double);
    case LcmType::kRange:
      return kValuesAt + sizeof(double);
    default:
      return 0;
  }
}

GpsSample lcm_fix_in(std::int64_t t_ns, std::span<const std::uint8_t> message) {
  const auto delivered_ns = big_endian_at<std::int64_t>(message, kValuesAt);
  constexpr std::int64_t kMaxDelayNs = 10 * kNsPerS;
  const bool is_later = t_ns >= 0 && delivered_ns >= t_ns && delivered_ns - t_ns <= kMaxDelayNs;
  GpsSample sample = gps_without_fix(t_ns, is_later ? delivered_ns : t_ns);
  if (big_endian_at<std::int8_t>(message, kValuesAt + 8) < 3) return sample;
  const auto value = [&](std::size_t i) {
    return big_endian_at<double>(message, kValuesAt + 9 + i * sizeof(double));
  };
  sample.fix = GpsFixType::k3d;
  sample.place = geodetic_from_deg(value(0), value(1), value(2));
  sample.velocity_ned_m_s = {value(3), value(4), value(5)};
  sample.horizontal_accuracy_m = value(6);
  sample.vertical_accuracy_m = value(7);
  sample.speed_accuracy_m_s = value(8);
  return sample;
}

}  // namespace

LcmType lcm_type_of(std::span<const std::uint8_t> message) {
  const auto fingerprint = big_endian_at<std::uint64_t>(message, 0);
  for (const LcmType type : kTimedTypes) {
    if (static_cast<std::uint64_t>(type) == fingerprint) return type;
  }
  return LcmType::kOther;
}

StreamDescription describe_channel(std::string_view channel, LcmType type) {
  StreamDescription description;
  description.name = channel;
  if (type == LcmType::kOther) description.vehicle = "recording";
  description.sensors = sensor_message_bytes(type) > 0;
  if (type == LcmType::kGps) description.height = HeightDatum::kEllipsoid;
  if (type == LcmType::kTruth) {
    description.position = PositionKind::kLocal;
    description.attitude = true;
    description.origin = SourceOrigin::kSimulation;
  }
  return description;
}

std::optional<std::int64_t> lcm_time_ns(std::span<const std::uint8_t> message) {
  if (message.size() < kTimeAt + sizeof(std::int64_t)) return std::nullopt;
  return big_endian_at<std::int64_t>(message, kTimeAt);
}

bool pass_truth(std::span<const std::uint8_t> message,
                StreamId id,
                const LogTime& time,
                LogSink& sink) {
  if (message.size() < kTruthBytes) return false;
  const auto number = [&](std::size_t at, std::size_t i) {
    return big_endian_at<double>(message, at + i * sizeof(double));
  };
  const Eigen::Vector3d p_enu(
      number(kTruthPositionAt, 0), number(kTruthPositionAt, 1), number(kTruthPositionAt, 2));
  sink.position(id, time, {p_enu.y(), p_enu.x(), -p_enu.z()});
  const std::size_t at = kTruthOrientationAt;
  const Eigen::Quaterniond R_enu_camera(number(at, 3), number(at, 0), number(at, 1), number(at, 2));
  sink.attitude(id, time, R_enu_ned() * R_enu_camera * R_body_camera_nadir().conjugate());
  return true;
}

std::optional<SensorSamples> lcm_samples_in(LcmType type, std::span<const std::uint8_t> message) {
  if (message.size() < sensor_message_bytes(type)) return std::nullopt;
  const std::int64_t t_ns = lcm_time_ns(message).value_or(0);
  const auto value = [&](std::size_t i) {
    return big_endian_at<double>(message, kValuesAt + i * sizeof(double));
  };
  SensorSamples samples;
  switch (type) {
    case LcmType::kImu:
      (void)add_measured(
          samples, ImuSample{t_ns, {value(3), value(4), value(5)}, {value(0), value(1), value(2)}});
      break;
    case LcmType::kBarometer:
      (void)add_measured(samples, BarometerSample{t_ns, value(0), value(1)});
      break;
    case LcmType::kGps:
      (void)add_measured(samples, lcm_fix_in(t_ns, message));
      break;
    case LcmType::kAirspeed:
      (void)add_measured(samples, AirspeedSample{t_ns, value(0), value(1)});
      break;
    case LcmType::kMagnetometer:
      (void)add_measured(samples, MagnetometerSample{t_ns, {value(0), value(1), value(2)}});
      break;
    case LcmType::kRange:
      (void)add_measured(samples, RangeSample{t_ns, value(0)});
      break;
    default:
      break;
  }
  return samples;
}

}  // namespace overfly::flight::logs
