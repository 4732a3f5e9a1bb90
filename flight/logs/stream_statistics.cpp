#include "flight/logs/stream_statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "core/motion/pose.hpp"
#include "core/text/number_text.hpp"
#include "core/time.hpp"

namespace overfly::flight::logs {
namespace {

constexpr std::int64_t kShortestGapNs = kNsPerS / 10;
constexpr double kGapRatio = 5.0;
constexpr std::uint64_t kIntervalsForGap = 10;
constexpr double kJumpM = 20.0;
constexpr double kJumpSpeedMS = 150.0;
/// Metres per degree of latitude on a sphere: enough to distinguish a flight from an aircraft at
/// rest.
constexpr double kMPerDeg = 111195.0;

double distance_m(PositionKind kind, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  if (kind == PositionKind::kLocal) return (to - from).head<2>().norm();
  double lon_step_deg = std::abs(to.y() - from.y());
  lon_step_deg = std::min(lon_step_deg, 360.0 - lon_step_deg);
  return kMPerDeg * std::hypot(to.x() - from.x(), lon_step_deg * std::cos(rad_from_deg(from.x())));
}

std::string text_of(const WrongValue& value, PositionKind kind) {
  if (value.quaternion_norm) return "a quaternion of norm " + short_text(*value.quaternion_norm);
  const auto texts = [](const Eigen::Vector3d& numbers, const std::array<const char*, 3>& names) {
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i) {
      text += (i > 0 ? ", " : "") + std::string(names[i]) + " " +
              short_text(numbers[static_cast<Eigen::Index>(i)]);
    }
    return text;
  };
  if (value.angles) {
    const RollPitchYaw& angles = *value.angles;
    return texts({deg_from_rad(angles.roll_rad),
                  deg_from_rad(angles.pitch_rad),
                  deg_from_rad(angles.yaw_rad)},
                 {"roll", "pitch", "yaw"}) +
           " deg";
  }
  const Eigen::Vector3d position = value.position.value_or(Eigen::Vector3d::Zero());
  return kind == PositionKind::kLocal
             ? texts(position, {"north", "east", "down"}) + " m"
             : texts(position, {"latitude", "longitude", "height"}) + " (deg, m)";
}

}  // namespace

double jump_between_m(PositionKind kind,
                      const Eigen::Vector3d& from,
                      const Eigen::Vector3d& to,
                      std::int64_t interval_ns) {
  const double jump_m = std::hypot(distance_m(kind, from, to), to.z() - from.z());
  const double step_s = std::abs(s_from_ns(interval_ns));
  return jump_m > kJumpM + kJumpSpeedMS * step_s ? jump_m : 0.0;
}

StreamStatistics::StreamStatistics(StreamDescription description) {
  info_.description = std::move(description);
  info_.georeferenced = info_.description.position == PositionKind::kGeodetic;
}

void StreamStatistics::message(const std::optional<LogTime>& time) {
  ++info_.messages;
  if (!time) return;
  if (last_ && last_->boot == time->boot) {
    const std::int64_t interval_ns = time->t_ns - last_->t_ns;
    if (interval_ns < 0) {
      ++info_.backward;
    } else {
      if (message_gaps_.take(interval_ns)) {
        ++info_.gaps;
        info_.longest_gap_ns = std::max(info_.longest_gap_ns, interval_ns);
      }
    }
    boot_.last_ns = std::max(boot_.last_ns, time->t_ns);
  } else {
    if (boot_.messages > longest_boot_.messages) longest_boot_ = boot_;
    boot_ = {time->t_ns, time->t_ns, 0};
  }
  ++boot_.messages;
  last_ = time;
}

bool StreamStatistics::GapFinder::take(std::int64_t interval_ns) {
  const double interval_s = s_from_ns(interval_ns);
  const bool gap = intervals_ >= kIntervalsForGap && interval_ns > kShortestGapNs &&
                   interval_s > kGapRatio * sum_s_ / static_cast<double>(intervals_);
  ++intervals_;
  sum_s_ += interval_s;
  return gap;
}

void StreamStatistics::position(const LogTime& time, const Eigen::Vector3d& value) {
  const PositionKind kind = info_.description.position;
  const double height_m = kind == PositionKind::kLocal ? -value.z() : value.z();
  if (!first_position_) {
    first_position_ = value;
    info_.lowest_m = info_.highest_m = height_m;
  } else if (time.boot == position_time_.boot) {
    const std::int64_t interval_ns = time.t_ns - position_time_.t_ns;
    if (interval_ns >= 0 && position_gaps_.take(interval_ns)) {
      ++info_.position_gaps;
      info_.longest_position_gap_ns = std::max(info_.longest_position_gap_ns, interval_ns);
    }
    const double jump_m = jump_between_m(kind, last_position_, value, interval_ns);
    if (jump_m > 0.0) {
      ++info_.jumps;
      info_.largest_jump_m = std::max(info_.largest_jump_m, jump_m);
    }
  }
  position_time_ = time;
  last_position_ = value;
  ++info_.positions;
  info_.reach_m = std::max(info_.reach_m, distance_m(kind, *first_position_, value));
  info_.lowest_m = std::min(info_.lowest_m, height_m);
  info_.highest_m = std::max(info_.highest_m, height_m);
}

void StreamStatistics::wrong_value(const LogTime& time, const WrongValue& value) {
  // Latitude and longitude 0 stand for no fix.
  if (value.position && value.position->head<2>().isZero(0.0)) return;
  ++info_.wrong_values;
  if (!info_.first_wrong_value) info_.first_wrong_value = {time, value};
}

std::string wrong_values_text(const StreamInfo& stream) {
  if (!stream.first_wrong_value) return {};
  const auto& [time, value] = *stream.first_wrong_value;
  return stream.description.name + ": " + counted(stream.wrong_values, "sample") +
         " cannot be right and " + (stream.wrong_values == 1 ? "was" : "were") +
         " left out, the first at " + short_text(s_from_ns(time.t_ns)) +
         " s: " + text_of(value, stream.description.position);
}

StreamInfo StreamStatistics::info() const {
  StreamInfo info = info_;
  const Span& span = boot_.messages >= longest_boot_.messages ? boot_ : longest_boot_;
  if (span.messages > 0) {
    info.first_ns = span.first_ns;
    info.last_ns = span.last_ns;
  }
  if (message_gaps_.sum_s() > 0.0) {
    info.rate_hz = static_cast<double>(message_gaps_.intervals()) / message_gaps_.sum_s();
  }
  return info;
}

}  // namespace overfly::flight::logs
