#include "flight/mavlink/vehicle/time_sync.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/time.hpp"

namespace overfly::flight::mavlink {
namespace {

constexpr std::int64_t kMs = 1'000'000;

/// Answers of a vehicle whose clock runs `rate` times as fast, over a link with delays of
/// `delay_ms` to 3 `delay_ms` each way, for `seconds`.
void let_answer(
    TimeSync& sync, double rate, std::int64_t vehicle_start_ns, double delay_ms, int seconds) {
  std::uint32_t state = 7;
  const auto random_ms = [&] {
    state = state * 1664525U + 1013904223U;
    return delay_ms * (1.0 + 2.0 * (state >> 8U) / 16777216.0);
  };
  for (int i = 0; i < 10 * seconds; ++i) {
    const std::int64_t sent_ns = 50 * kNsPerS + i * 100 * kMs;
    const auto there_ns = static_cast<std::int64_t>(random_ms() * 1e6);
    const auto back_ns = static_cast<std::int64_t>(random_ms() * 1e6);
    const auto vehicle_ns = vehicle_start_ns + static_cast<std::int64_t>(
                                                   rate * static_cast<double>(sent_ns + there_ns));
    sync.take(sent_ns, vehicle_ns, sent_ns + there_ns + back_ns);
  }
}

TEST(TimeSync, KnowsTheClockWithinTheAsymmetryOfTheLink) {
  for (const double rate : {1.0, 5.0, 10.0}) {
    TimeSync sync;
    EXPECT_FALSE(sync.vehicle_ns_at(0));
    let_answer(sync, rate, 123 * kNsPerS, 1.0, 10);
    const std::int64_t local_ns = 60 * kNsPerS;
    const auto vehicle_ns = sync.vehicle_ns_at(local_ns);
    ASSERT_TRUE(vehicle_ns);
    const double error_ms = static_cast<double>(*vehicle_ns - 123 * kNsPerS) * 1e-6 - rate * 60e3;
    // One answer is off by at most 1 ms of asymmetry, times the speed-up.
    EXPECT_LT(std::abs(error_ms), 0.5 * rate) << rate;
    EXPECT_NEAR(sync.rate(), rate, 1e-3 * rate);
  }
}

TEST(TimeSync, StartsAgainWhenTheVehicleDoes) {
  TimeSync sync;
  let_answer(sync, 1.0, 500 * kNsPerS, 1.0, 5);
  ASSERT_TRUE(sync.vehicle_ns_at(60 * kNsPerS));
  sync.take(56 * kNsPerS, 3 * kNsPerS, 56 * kNsPerS + kMs);
  EXPECT_EQ(sync.restarts(), 1U);
  EXPECT_FALSE(sync.vehicle_ns_at(60 * kNsPerS));
}

TEST(TimeSync, IgnoresAnswersThatCannotBe) {
  TimeSync sync;
  sync.take(2 * kNsPerS, kNsPerS, kNsPerS);  // received before it was sent
  sync.take(0, kNsPerS, 11 * kNsPerS);       // too late
  sync.take(0, -1, kMs);                     // no time since a start
  sync.take(0, INT64_MAX, kMs);
  EXPECT_FALSE(sync.round_trip_ns());
}

}  // namespace
}  // namespace overfly::flight::mavlink
