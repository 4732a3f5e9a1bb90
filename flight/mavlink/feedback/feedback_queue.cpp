#include "flight/mavlink/feedback/feedback_queue.hpp"

#include <algorithm>

#include "core/time.hpp"

namespace overfly::flight::mavlink {
namespace {

constexpr double kMostAheadS = 1.0;
constexpr double kMostBehindS = 0.05;
/// Estimates that wait: 8 s of a camera with 60 Hz.
constexpr std::size_t kMostWaiting = 512;
/// A capture further in the future is one of a clock that has started again.
constexpr std::int64_t kMostFutureNs = 5 * kNsPerS;

}  // namespace

std::optional<VehicleNow> vehicle_now(const std::optional<VehicleClock>& timesync,
                                      const std::optional<std::int64_t>& heard_ns) {
  if (!heard_ns) return std::nullopt;
  if (timesync) {
    const double speed_up = std::clamp(timesync->rate, 1.0, 1000.0);
    // As numbers that cannot overflow: answers may hold any time.
    const double ahead_s =
        (static_cast<double>(timesync->vehicle_ns) - static_cast<double>(*heard_ns)) * 1e-9;
    if (ahead_s <= kMostAheadS * speed_up && ahead_s >= -kMostBehindS * speed_up) {
      return VehicleNow{timesync->vehicle_ns, true};
    }
  }
  return VehicleNow{*heard_ns, false};
}

void FeedbackQueue::add(const FeedbackSample& sample) {
  // Of a camera with a rate that the period divides, every n-th estimate: stamps are rounded.
  constexpr std::int64_t kRoundingNs = 1'000'000;
  if (last_added_ns_ && sample.t_ns - *last_added_ns_ < period_ns_ - kRoundingNs) return;
  last_added_ns_ = sample.t_ns;
  waiting_.push_back(sample);
  if (waiting_.size() <= kMostWaiting) return;
  waiting_.pop_front();
  ++clock_back_;
}

std::vector<FeedbackSample> FeedbackQueue::take_due(std::int64_t now_ns) {
  std::vector<FeedbackSample> due;
  while (!waiting_.empty()) {
    const FeedbackSample& first = waiting_.front();
    const std::int64_t age_ns = now_ns - first.t_ns;
    if (age_ns > kOldestNs) {
      ++too_late_;
    } else if (age_ns < -kMostFutureNs) {
      ++clock_back_;
    } else if (age_ns >= latency_ns_) {
      due.push_back(first);
    } else {
      break;
    }
    waiting_.pop_front();
  }
  return due;
}

std::optional<std::int64_t> FeedbackQueue::next_due_ns() const {
  if (waiting_.empty()) return std::nullopt;
  return waiting_.front().t_ns + latency_ns_;
}

}  // namespace overfly::flight::mavlink
