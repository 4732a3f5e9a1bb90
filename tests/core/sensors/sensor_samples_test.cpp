// Which samples wait for a frame, by the time at which they were available.
#include "core/sensors/sensor_samples.hpp"

#include <gtest/gtest.h>

namespace overfly {
namespace {

constexpr std::int64_t kMs = 1'000'000;

ImuSample imu_at(std::int64_t t_ns) { return {t_ns, {}, {}, 5 * kMs}; }

GpsSample fix_at(std::int64_t t_ns, std::int64_t delay_ns) {
  GpsSample fix;
  fix.t_ns = t_ns;
  fix.delivered_ns = t_ns + delay_ns;
  return fix;
}

TEST(SensorSamples, AreAvailableAfterTheirIntervalOrTheirDelivery) {
  EXPECT_EQ(available_ns(imu_at(100 * kMs)), 102 * kMs + kMs / 2);
  EXPECT_EQ(available_ns(fix_at(100 * kMs, 80 * kMs)), 180 * kMs);
  EXPECT_EQ(available_ns(RangeSample{7 * kMs, 1.0}), 7 * kMs);
  SensorSamples samples;
  EXPECT_FALSE(first_available_ns(samples));
  samples.imu = {imu_at(100 * kMs)};
  samples.gps = {fix_at(90 * kMs, 20 * kMs)};
  EXPECT_EQ(first_available_ns(samples), 102 * kMs + kMs / 2);
}

TEST(SensorSamples, KeepALateFixThatHasJustBeenDelivered) {
  SensorSamples samples;
  for (std::int64_t ms = 0; ms < 1000; ms += 5) samples.imu.push_back(imu_at(ms * kMs));
  // Measured 10 s ago and delivered with the newest samples.
  samples.gps = {fix_at(-9'500 * kMs, 10'000 * kMs)};
  SensorSamples recent = samples;
  drop_older_than(recent, 600 * kMs);
  ASSERT_EQ(recent.gps.size(), 1U);
  EXPECT_EQ(recent.imu.front().t_ns, 395 * kMs) << "available at 397.5 ms, the newest at 997.5 ms";
  drop_available_at(samples, 500 * kMs);
  EXPECT_TRUE(samples.gps.empty()) << "delivered at 500 ms";
  EXPECT_EQ(samples.imu.front().t_ns, 500 * kMs) << "available at 502.5 ms";
}

}  // namespace
}  // namespace overfly
