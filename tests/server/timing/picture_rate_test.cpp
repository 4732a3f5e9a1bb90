// Pictures for viewers during real-time flights: rate and threads.
#include "server/timing/picture_rate.hpp"

#include <gtest/gtest.h>
#include <sched.h>

#include <future>

#include "core/time.hpp"
#include "server/runs/run_manager.hpp"
#include "server/views/view_service.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server {
namespace {

constexpr std::int64_t kPeriodNs = 32'000'000;

/// A flight at 31 Hz whose viewers get pictures all the time.
class PictureRateTest : public ::testing::Test {
 protected:
  PictureRateTest() { rate_.flight_began(now_ns_); }

  /// Frames of one second, each with that share of its period left.
  void fly_s(int seconds, double left = 0.5, bool watched = true) {
    for (int i = 0; i < 32 * seconds; ++i) {
      now_ns_ += kPeriodNs;
      if (watched) rate_.picture_made();
      rate_.frame_made(now_ns_, kPeriodNs, static_cast<std::int64_t>(left * kPeriodNs));
    }
  }
  void miss() {
    now_ns_ += kPeriodNs;
    rate_.frame_missed(now_ns_);
  }

  PictureRate rate_;
  std::int64_t now_ns_ = 1000;
};

TEST_F(PictureRateTest, BeginsLowAndRisesWhileTheFlightHasTime) {
  EXPECT_EQ(rate_.limit_hz(), PictureRate::kFirstHz);
  fly_s(3);
  EXPECT_EQ(rate_.limit_hz(), 10.0);
  fly_s(2);
  EXPECT_EQ(rate_.limit_hz(), 15.0);
  fly_s(2);
  EXPECT_EQ(rate_.limit_hz(), std::nullopt);
}

TEST_F(PictureRateTest, FallsWithEachMissedFrameToOncePerSecond) {
  miss();
  EXPECT_EQ(rate_.limit_hz(), 2.0);
  miss();
  miss();
  EXPECT_EQ(rate_.limit_hz(), PictureRate::kLeastHz);
}

TEST_F(PictureRateTest, FallsWhereMostFramesAreReadyOnlyJustInTime) {
  fly_s(1, 0.05);
  EXPECT_EQ(rate_.limit_hz(), 2.0);
}

TEST_F(PictureRateTest, DoesNotRiseForWhatNobodyWatches) {
  fly_s(30, 0.5, false);
  EXPECT_EQ(rate_.limit_hz(), PictureRate::kFirstHz);
}

TEST_F(PictureRateTest, TriesAgainLaterEachTimeThatItWasTooMuch) {
  int longest_s = 0;
  for (int trial = 0; trial < 4; ++trial) {
    int waited_s = 0;
    while (rate_.limit_hz() == PictureRate::kFirstHz) {
      fly_s(1);
      ++waited_s;
    }
    EXPECT_GT(waited_s, longest_s) << "trial " << trial;
    longest_s = waited_s;
    EXPECT_EQ(rate_.limit_hz(), 10.0);
    miss();
  }
}

TEST_F(PictureRateTest, IsFreeWhenTheLastFlightIsOver) {
  rate_.flight_began(now_ns_);
  rate_.flight_ended();
  EXPECT_TRUE(rate_.flying());
  EXPECT_EQ(rate_.limit_hz(), PictureRate::kFirstHz);
  rate_.flight_ended();
  EXPECT_FALSE(rate_.flying());
  EXPECT_EQ(rate_.limit_hz(), std::nullopt);
}

TEST(ViewService, DrawsOnAProcessorThatNobodyElseWantsWhileAFlightIsInTheAir) {
  const overfly::testing::TemporaryFolder folder;
  RunManagerOptions options;
  options.runs_folder = folder.path() / "runs";
  options.scenarios_folder = folder.path();
  options.renderer_factory = testing::noop_factory();
  const auto runs = std::move(RunManager::create(options).value());
  ViewService views(*runs);
  // What is asked for does not exist: the answer comes on the thread that would have drawn it.
  const auto policy = [&] {
    std::promise<int> asked;
    PictureRequest request;
    request.run_id = "none";
    views.request(1, 1, request, [&](const Result<Picture>& picture) {
      EXPECT_FALSE(picture.ok());
      asked.set_value(sched_getscheduler(0));
    });
    return asked.get_future().get();
  };
  EXPECT_EQ(policy(), SCHED_OTHER);
  runs->picture_rate().flight_began(0);
  EXPECT_EQ(policy(), SCHED_IDLE);
  runs->picture_rate().flight_ended();
  EXPECT_EQ(policy(), SCHED_OTHER);
}

}  // namespace
}  // namespace overfly::server
