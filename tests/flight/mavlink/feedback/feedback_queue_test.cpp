// When estimates are sent: all clocks are numbers.
#include "flight/mavlink/feedback/feedback_queue.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/time.hpp"
#include "flight/mavlink/vehicle/time_sync.hpp"

namespace overfly::flight::mavlink {
namespace {

constexpr std::int64_t kMilliNs = 1'000'000;

FeedbackSample captured_at(std::int64_t t_ns) {
  FeedbackSample sample;
  sample.t_ns = t_ns;
  return sample;
}

/// A vehicle whose clock is `offset_ns` ahead and runs `rate` times as fast, as TIMESYNC over a
/// link with 4 ms there and 4 ms back measures it.
TimeSync synced(std::int64_t offset_ns, double rate) {
  TimeSync sync;
  for (int i = 0; i < 32; ++i) {
    const std::int64_t sent_ns = i * 100 * kMilliNs;
    const auto there_ns =
        static_cast<std::int64_t>(rate * static_cast<double>(sent_ns + 4 * kMilliNs));
    sync.take(sent_ns, offset_ns + there_ns, sent_ns + 8 * kMilliNs);
  }
  return sync;
}

TEST(FeedbackQueue, SendsWhenTheLatencyHasPassedByTheVehiclesClock) {
  for (const std::int64_t latency_ms : {0, 37, 400}) {
    for (const double rate : {1.0, 5.0}) {
      const std::int64_t offset_ns = 1'234'567 * kMilliNs;
      const TimeSync sync = synced(offset_ns, rate);
      FeedbackQueue queue(latency_ms * kMilliNs, 0);
      const std::int64_t capture_ns = offset_ns + static_cast<std::int64_t>(rate * 3.2e9);
      queue.add(captured_at(capture_ns));
      EXPECT_EQ(queue.next_due_ns(), capture_ns + latency_ms * kMilliNs);
      // The machine's clock goes on in steps of 0.1 ms until it is sent.
      std::int64_t local_ns = 3100 * kMilliNs;
      std::vector<FeedbackSample> sent;
      for (; sent.empty() && local_ns < 4000 * kMilliNs; local_ns += kMilliNs / 10) {
        const VehicleClock clock{*sync.vehicle_ns_at(local_ns), sync.rate(), 8 * kMilliNs};
        // The latest message is 20 ms of the vehicle's clock old.
        const auto now = vehicle_now(clock, clock.vehicle_ns - 20 * kMilliNs);
        ASSERT_TRUE(now && now->by_timesync);
        sent = queue.take_due(now->ns);
      }
      ASSERT_EQ(sent.size(), 1U);
      EXPECT_EQ(sent[0].t_ns, capture_ns) << "the stamp is the capture's";
      const double expected_ms = 3200.0 + static_cast<double>(latency_ms) / rate;
      EXPECT_NEAR(static_cast<double>(local_ns) / kMilliNs, expected_ms, 0.3) << rate;
    }
  }
}

TEST(FeedbackQueue, SendsALateAnswerAtOnceAndAnOldOneNever) {
  FeedbackQueue queue(100 * kMilliNs, 0);
  queue.add(captured_at(1000 * kMilliNs));
  queue.add(captured_at(1032 * kMilliNs));
  queue.add(captured_at(1600 * kMilliNs));
  // 1000 ms is 510 ms old, 1032 ms is 478 ms old.
  const auto due = queue.take_due(1510 * kMilliNs);
  ASSERT_EQ(due.size(), 1U);
  EXPECT_EQ(due[0].t_ns, 1032 * kMilliNs);
  EXPECT_EQ(queue.too_late(), 1U);
  EXPECT_EQ(queue.next_due_ns(), 1700 * kMilliNs);
  EXPECT_TRUE(queue.take_due(1699 * kMilliNs).empty());
  EXPECT_EQ(queue.take_due(1700 * kMilliNs).size(), 1U);
}

TEST(FeedbackQueue, LeavesOutEstimatesOfAClockThatStartedAgain) {
  FeedbackQueue queue(0, 0);
  queue.add(captured_at(500 * kNsPerS));
  EXPECT_TRUE(queue.take_due(2 * kNsPerS).empty());
  EXPECT_EQ(queue.clock_back(), 1U);
  EXPECT_FALSE(queue.next_due_ns());
}

TEST(FeedbackQueue, KeepsToItsRate) {
  FeedbackQueue queue(0, kNsPerS / 10);
  // A camera of 30 Hz: stamps are rounded to nanoseconds, and three periods are 0.1 s.
  for (int k = 0; k < 31; ++k) queue.add(captured_at(frame_time_ns(k, {30, 1})));
  std::size_t sent = 0;
  for (std::int64_t now_ns = 0; now_ns <= kNsPerS; now_ns += 10 * kMilliNs) {
    sent += queue.take_due(now_ns).size();
  }
  EXPECT_EQ(sent, 11U);
}

TEST(FeedbackQueue, IsBoundedWhileTheVehiclesClockStands) {
  FeedbackQueue queue(400 * kMilliNs, 0);
  for (int i = 0; i < 100'000; ++i) queue.add(captured_at(i));
  EXPECT_GT(queue.clock_back(), 99'000U);
  EXPECT_LE(queue.take_due(401 * kMilliNs).size(), 512U);
}

TEST(VehicleNow, IsThatOfTheMessagesWithoutTimesync) {
  EXPECT_FALSE(vehicle_now(std::nullopt, std::nullopt));
  const auto now = vehicle_now(std::nullopt, 7 * kNsPerS);
  ASSERT_TRUE(now);
  EXPECT_EQ(now->ns, 7 * kNsPerS);
  EXPECT_FALSE(now->by_timesync);
}

TEST(VehicleNow, DoesNotBelieveATimesyncThatDiffersFromTheMessages) {
  const std::int64_t heard_ns = 100 * kNsPerS;
  const auto by_timesync = [&](std::int64_t vehicle_ns, double rate) {
    const auto now = vehicle_now(VehicleClock{vehicle_ns, rate, kMilliNs}, heard_ns);
    EXPECT_TRUE(now);
    EXPECT_TRUE(now->by_timesync || now->ns == heard_ns);
    return now->by_timesync;
  };
  EXPECT_TRUE(by_timesync(heard_ns + 990 * kMilliNs, 1.0));
  EXPECT_FALSE(by_timesync(heard_ns + 1010 * kMilliNs, 1.0));
  EXPECT_TRUE(by_timesync(heard_ns + 4 * kNsPerS, 5.0));
  EXPECT_TRUE(by_timesync(heard_ns - 40 * kMilliNs, 1.0));
  EXPECT_FALSE(by_timesync(heard_ns - 60 * kMilliNs, 1.0));
  // Unix time, and nonsense.
  EXPECT_FALSE(by_timesync(1'790'000'000 * kNsPerS, 1.0));
  EXPECT_FALSE(by_timesync(std::numeric_limits<std::int64_t>::min(), 1.0));
  EXPECT_FALSE(by_timesync(std::numeric_limits<std::int64_t>::max(), -1e300));
  EXPECT_FALSE(by_timesync(heard_ns, std::numeric_limits<double>::quiet_NaN()));
}

}  // namespace
}  // namespace overfly::flight::mavlink
