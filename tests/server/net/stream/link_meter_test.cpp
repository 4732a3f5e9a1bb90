#include "server/net/stream/pictures/link_meter.hpp"

#include <gtest/gtest.h>

namespace overfly::net {
namespace {

constexpr std::int64_t kTickNs = 20'000'000;

/// Pictures that move, and wait for a share of the time.
class LinkMeterTest : public ::testing::Test {
 protected:
  void play(double seconds, double blocked_share) {
    constexpr int kPeriod = 10;
    for (double t_s = 0.0; t_s < seconds; t_s += 0.02) {
      now_ns_ += kTickNs;
      meter_.note(true, tick_++ % kPeriod < blocked_share * kPeriod, now_ns_);
    }
  }
  LinkMeter meter_;
  std::int64_t now_ns_ = 1;
  int tick_ = 0;
};

TEST_F(LinkMeterTest, ReducesNothingWhilePicturesHardlyWait) {
  play(30.0, 0.1);
  EXPECT_EQ(meter_.reduction(), 0);
  EXPECT_FALSE(meter_.tight());
}

TEST_F(LinkMeterTest, ReducesStepByStepWhilePicturesWait) {
  play(2.5, 0.8);
  EXPECT_GE(meter_.reduction(), 1);
  play(20.0, 0.8);
  EXPECT_EQ(meter_.reduction(), LinkMeter::kMostReduction);
}

TEST_F(LinkMeterTest, RestoresWhenTheWayIsFreeAgain) {
  play(10.0, 0.8);
  ASSERT_EQ(meter_.reduction(), LinkMeter::kMostReduction);
  play(60.0, 0.0);
  EXPECT_EQ(meter_.reduction(), 0);
}

TEST_F(LinkMeterTest, WaitsLongerAfterEachStepBackThatWasTooEarly) {
  // Without a reduction the way is too narrow, with one it is wide.
  play(3.0, 0.8);
  int steps_back = 0;
  int before = meter_.reduction();
  for (int second = 0; second < 300; ++second) {
    play(1.0, meter_.reduction() == 0 ? 0.8 : 0.0);
    steps_back += before > 0 && meter_.reduction() == 0 ? 1 : 0;
    before = meter_.reduction();
  }
  EXPECT_GE(steps_back, 2);
  EXPECT_LE(steps_back, 10) << "every three seconds would be about 60";
}

TEST_F(LinkMeterTest, RestoresQuicklyOnceAStepBackHoldsThatWasTooEarlyBefore) {
  // For minutes only the smallest pictures pass, so that the pauses have become long.
  for (int second = 0; second < 90; ++second) {
    play(1.0, meter_.reduction() < LinkMeter::kMostReduction ? 0.8 : 0.0);
  }
  while (meter_.reduction() < LinkMeter::kMostReduction) play(1.0, 0.8);
  int seconds = 0;
  for (; meter_.reduction() == LinkMeter::kMostReduction; ++seconds) play(1.0, 0.0);
  EXPECT_GT(seconds, 10) << "the step back was too early several times";
  for (seconds = 0; meter_.reduction() > 0 && seconds < 100; ++seconds) play(1.0, 0.0);
  EXPECT_LE(seconds, 15) << "for the other three steps";
}

TEST_F(LinkMeterTest, JudgesNothingWhilePicturesRest) {
  for (int i = 0; i < 1000; ++i) meter_.note(false, true, now_ns_ += kTickNs);
  EXPECT_EQ(meter_.reduction(), 0);
}

TEST(ReductionAt, GrowsWithTheStep) {
  for (int step = 1; step <= LinkMeter::kMostReduction; ++step) {
    EXPECT_GE(reduction_at(step).quality_less, reduction_at(step - 1).quality_less);
    EXPECT_GE(reduction_at(step).halvings, reduction_at(step - 1).halvings);
  }
  EXPECT_EQ(reduction_at(0).quality_less, 0);
  EXPECT_EQ(reduction_at(0).halvings, 0);
}

}  // namespace
}  // namespace overfly::net
