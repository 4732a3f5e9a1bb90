#include "vo_bridges/ros1/answer_patience.hpp"

#include <gtest/gtest.h>

namespace overfly::ros1 {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kPeriodNs = 32'000'000;

/// A virtual clock and frames that are 32 ms apart.
struct Frames {
  AnswerPatience patience;
  AnswerPatience::Clock::time_point now{};
  std::int64_t t_ns = 0;

  std::chrono::nanoseconds next() {
    t_ns += kPeriodNs;
    return patience.begin(t_ns, now);
  }
  void answer_after(std::chrono::nanoseconds took) {
    now += took;
    patience.answered(t_ns, now);
  }
};

TEST(AnswerPatience, WaitsInLockstepWhileTheEstimatorAnswers) {
  Frames frames{AnswerPatience(true, 2s)};
  EXPECT_EQ(frames.next(), 2s) << "the first frame is given a chance";
  frames.answer_after(1s);
  EXPECT_EQ(frames.next(), 2s);
}

TEST(AnswerPatience, GoesByTheClockInLockstepFromTheFirstFrameWithoutAnswer) {
  Frames frames{AnswerPatience(true, 2s)};
  (void)frames.next();
  frames.patience.gave_up();
  EXPECT_EQ(frames.next(), 32ms);
  frames.patience.gave_up();
  EXPECT_EQ(frames.next(), 32ms);
  frames.answer_after(40ms);  // late
  EXPECT_EQ(frames.next(), 2s) << "it does answer";
}

TEST(AnswerPatience, DoesNotTakeAStrayForAnAnswer) {
  Frames frames{AnswerPatience(true, 2s)};
  (void)frames.next();
  frames.patience.gave_up();
  frames.patience.answered(frames.t_ns + kPeriodNs / 2, frames.now);
  EXPECT_EQ(frames.next(), 32ms);
  frames.patience.answered(frames.t_ns + 1000, frames.now);  // of a stamp kept in a double
  EXPECT_EQ(frames.next(), 2s);
}

TEST(AnswerPatience, AllowsByTheClockTwiceWhatAnswersTook) {
  Frames frames{AnswerPatience(false, 2s)};
  EXPECT_EQ(frames.next(), 100ms);
  frames.answer_after(10ms);
  EXPECT_EQ(frames.next(), 32ms) << "no less than to the next frame";
  for (int i = 0; i < 100; ++i) {
    frames.answer_after(50ms);
    (void)frames.next();
  }
  EXPECT_GT(frames.next(), 99ms);
  EXPECT_LE(frames.next(), 100ms);
}

TEST(AnswerPatience, NeverExceedsTheLimit) {
  Frames frames{AnswerPatience(false, 60ms)};
  EXPECT_EQ(frames.next(), 60ms);
  frames.answer_after(5s);
  EXPECT_EQ(frames.next(), 60ms);
}

}  // namespace
}  // namespace overfly::ros1
