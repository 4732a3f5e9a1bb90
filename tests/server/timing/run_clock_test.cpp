// Waiting that is cancelled.
#include "server/timing/run_clock.hpp"

#include <gtest/gtest.h>

namespace overfly::server {
namespace {

constexpr std::int64_t kHourNs = 3600'000'000'000;

TEST(RunClock, MachineClockAsksWhileItWaits) {
  RunClock& clock = machine_clock();
  int asked = 0;
  EXPECT_FALSE(clock.wait_until_ns(clock.now_ns() + kHourNs, [&] { return ++asked == 3; }));
  EXPECT_EQ(asked, 3);
  EXPECT_TRUE(clock.wait_until_ns(clock.now_ns() + 1000, [] { return false; }));
  EXPECT_TRUE(clock.wait_until_ns(clock.now_ns() - 1000, [] { return false; }));
}

}  // namespace
}  // namespace overfly::server
