#include "flight/logs/stream_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/motion/pose.hpp"
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
      count_interval(interval_ns);
    }
    boot_.last_ns = std::max(boot_.last_ns, time->t_ns);
  } else {
    if (boot_.messages > longest_boot_.messages) longest_boot_ = boot_;
    boot_ = {time->t_ns, time->t_ns, 0};
  }
  ++boot_.messages;
  last_ = time;
}

void StreamStatistics::count_interval(std::int64_t interval_ns) {
  const double interval_s = s_from_ns(interval_ns);
  if (intervals_ >= kIntervalsForGap && interval_ns > kShortestGapNs &&
      interval_s > kGapRatio * interval_sum_s_ / static_cast<double>(intervals_)) {
    ++info_.gaps;
    info_.longest_gap_ns = std::max(info_.longest_gap_ns, interval_ns);
  }
  ++intervals_;
  interval_sum_s_ += interval_s;
}

void StreamStatistics::position(const LogTime& time, const Eigen::Vector3d& value) {
  const PositionKind kind = info_.description.position;
  const double height_m = kind == PositionKind::kLocal ? -value.z() : value.z();
  if (!first_position_) {
    first_position_ = value;
    info_.lowest_m = info_.highest_m = height_m;
  } else if (time.boot == position_time_.boot) {
    const double jump_m =
        jump_between_m(kind, last_position_, value, time.t_ns - position_time_.t_ns);
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

StreamInfo StreamStatistics::info() const {
  StreamInfo info = info_;
  const Span& span = boot_.messages >= longest_boot_.messages ? boot_ : longest_boot_;
  if (span.messages > 0) {
    info.first_ns = span.first_ns;
    info.last_ns = span.last_ns;
  }
  if (interval_sum_s_ > 0.0) info.rate_hz = static_cast<double>(intervals_) / interval_sum_s_;
  return info;
}

}  // namespace overfly::flight::logs
