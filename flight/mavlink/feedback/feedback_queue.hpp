// Estimates that wait until they may be sent, by the vehicle's clock.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "flight/mavlink/feedback/feedback_track.hpp"
#include "flight/mavlink/vehicle/vehicle.hpp"

namespace overfly::flight::mavlink {

/// The vehicle's clock now.
struct VehicleNow {
  std::int64_t ns = 0;
  bool by_timesync = false;
};

/// The vehicle's clock, from its answers to TIMESYNC as long as they agree with the times in its
/// messages: ahead of the latest of them by no more than a second, behind by no more than 50 ms,
/// both times the vehicle's speed-up. Otherwise the latest time in its messages, which is late by
/// their period.
/// @param timesync  empty without answers
/// @param heard_ns  the latest time in a message; empty before the first
/// @return empty before the first message with a time
[[nodiscard]] std::optional<VehicleNow> vehicle_now(const std::optional<VehicleClock>& timesync,
                                                    const std::optional<std::int64_t>& heard_ns);

/// Holds each estimate until its latency has passed. Times are those of the vehicle's clock.
class FeedbackQueue {
 public:
  /// Older estimates are not sent: ArduPilot's correction of offboard time stamps moves the stamp
  /// of a message that is later than this, so that an old position would count as a new one.
  static constexpr std::int64_t kOldestNs = 500'000'000;

  /// @param latency_ns  between capture and sending
  /// @param period_ns   shortest time between the captures of estimates that are sent; 0: none
  FeedbackQueue(std::int64_t latency_ns, std::int64_t period_ns)
      : latency_ns_(latency_ns), period_ns_(period_ns) {}

  /// @param sample  its time is that of the vehicle's clock at the capture
  void add(const FeedbackSample& sample);
  /// The estimates whose latency has passed, in order.
  [[nodiscard]] std::vector<FeedbackSample> take_due(std::int64_t now_ns);
  /// When the next estimate is due; empty if none waits.
  [[nodiscard]] std::optional<std::int64_t> next_due_ns() const;

  /// How many wait.
  [[nodiscard]] std::size_t size() const { return waiting_.size(); }
  /// Estimates left out because they were too old, or because the vehicle's clock was too far back.
  [[nodiscard]] std::uint64_t too_late() const { return too_late_; }
  [[nodiscard]] std::uint64_t clock_back() const { return clock_back_; }

 private:
  std::int64_t latency_ns_;
  std::int64_t period_ns_;
  std::deque<FeedbackSample> waiting_;
  std::optional<std::int64_t> last_added_ns_;
  std::uint64_t too_late_ = 0;
  std::uint64_t clock_back_ = 0;
};

}  // namespace overfly::flight::mavlink
