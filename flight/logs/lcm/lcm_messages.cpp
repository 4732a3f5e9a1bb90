#include "flight/logs/lcm/lcm_messages.hpp"

#include <string>

#include "core/motion/pose.hpp"
#include "flight/logs/ned_attitude.hpp"

namespace overfly::flight::logs {
namespace {

constexpr LcmType kTimedTypes[] = {LcmType::kTruth,
                                   LcmType::kImage,
                                   LcmType::kPose,
                                   LcmType::kSimTime,
                                   LcmType::kDebug,
                                   LcmType::kWorldPose};

// Offsets behind the fingerprint (8), utime (8), t_ns (8), stamp_ns (8) and frame (8).
constexpr std::size_t kTimeAt = 16;
constexpr std::size_t kTruthPositionAt = 40;
constexpr std::size_t kTruthOrientationAt = kTruthPositionAt + 3 * sizeof(double);
constexpr std::size_t kTruthBytes = kTruthOrientationAt + 4 * sizeof(double);

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

}  // namespace overfly::flight::logs
