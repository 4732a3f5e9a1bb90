#include "vo_bridges/stamped_answers.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <thread>

namespace overfly {
namespace {

using std::chrono::hours;
using std::chrono::nanoseconds;

constexpr nanoseconds kAtOnce{0};

VoEstimate answer_of(std::int64_t frame) {
  VoEstimate estimate;
  estimate.sample.frame = frame;
  return estimate;
}

TEST(StampedAnswers, GivesTheAnswerThatIsAlreadyThereOnce) {
  StampedAnswers answers;
  answers.expect(100);
  EXPECT_TRUE(answers.deliver(100, answer_of(7)));
  const auto answer = answers.wait(100, kAtOnce);
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ(answer->sample.frame, 7);
  EXPECT_FALSE(answers.wait(100, hours(1)).has_value()) << "must not wait for a second one";
  EXPECT_EQ(answers.counts().answered, 1);
}

TEST(StampedAnswers, WakesTheWaiterWhenTheAnswerComesOnAnotherThread) {
  StampedAnswers answers;
  answers.expect(100);
  answers.expect(200);
  std::thread other([&] {
    answers.deliver(100, answer_of(1));
    answers.deliver(200, answer_of(2));
  });
  const auto answer = answers.take(200, hours(1));
  other.join();
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ(answer->sample.frame, 2);
}

TEST(StampedAnswers, KeepsExpectingAfterAWaitThatEndedInVain) {
  StampedAnswers answers;
  answers.expect(100);
  EXPECT_FALSE(answers.wait(100, kAtOnce).has_value());
  EXPECT_EQ(answers.counts().unanswered, 0);
  EXPECT_TRUE(answers.deliver(100, answer_of(1)));
  EXPECT_TRUE(answers.wait(100, kAtOnce).has_value());
}

TEST(StampedAnswers, CountsALateAnswerAndDoesNotKeepIt) {
  StampedAnswers answers;
  answers.expect(100);
  EXPECT_FALSE(answers.take(100, kAtOnce).has_value());
  EXPECT_FALSE(answers.deliver(100, answer_of(1)));
  EXPECT_FALSE(answers.wait(100, kAtOnce).has_value());
  const AnswerCounts counts = answers.counts();
  EXPECT_EQ(counts.unanswered, 1);
  EXPECT_EQ(counts.late, 1);
  EXPECT_EQ(counts.answered, 0);
}

TEST(StampedAnswers, CountsDuplicatesTakenOrNot) {
  StampedAnswers answers;
  answers.expect(100);
  answers.deliver(100, answer_of(1));
  EXPECT_FALSE(answers.deliver(100, answer_of(2)));
  EXPECT_EQ(answers.wait(100, kAtOnce)->sample.frame, 1) << "the first one counts";
  EXPECT_FALSE(answers.deliver(100, answer_of(3)));
  EXPECT_EQ(answers.counts().duplicate, 2);
}

TEST(StampedAnswers, CountsAnswersToFramesThatNeverWere) {
  StampedAnswers answers;
  EXPECT_FALSE(answers.deliver(100, answer_of(1)));
  answers.expect(100);
  EXPECT_FALSE(answers.deliver(101, answer_of(1)));
  EXPECT_EQ(answers.counts().unknown, 2);
  EXPECT_FALSE(answers.wait(101, hours(1)).has_value()) << "must not wait for a strange frame";
}

TEST(StampedAnswers, CountsAnswersThatOvertook) {
  StampedAnswers answers;
  for (const std::int64_t t_ns : {100, 200, 300}) answers.expect(t_ns);
  answers.deliver(200, answer_of(2));
  answers.deliver(100, answer_of(1));
  answers.deliver(300, answer_of(3));
  EXPECT_EQ(answers.counts().out_of_order, 1);
  EXPECT_EQ(answers.counts().answered, 3);
}

TEST(StampedAnswers, MatchesTheNearestFrameWithinItsTolerance) {
  StampedAnswers answers(10);
  answers.expect(100);
  answers.expect(115);
  EXPECT_TRUE(answers.deliver(108, answer_of(2))) << "7 ns from 115, 8 ns from 100";
  EXPECT_EQ(answers.wait(115, kAtOnce)->sample.frame, 2);
  EXPECT_TRUE(answers.deliver(90, answer_of(1)));
  EXPECT_EQ(answers.wait(100, kAtOnce)->sample.frame, 1);
  EXPECT_FALSE(answers.deliver(126, answer_of(3)));
  EXPECT_EQ(answers.counts().unknown, 1);
}

/// The difference of two such stamps is no 64-bit number with a sign.
TEST(StampedAnswers, MatchesNoStampThatIsFarFromEveryFrame) {
  using Limits = std::numeric_limits<std::int64_t>;
  for (const std::int64_t tolerance_ns : {0, 1000}) {
    for (const std::int64_t frame_ns : {std::int64_t{0}, Limits::min(), Limits::max()}) {
      StampedAnswers answers(tolerance_ns);
      answers.expect(frame_ns);
      for (const std::int64_t t_ns : {Limits::min(), std::int64_t{0}, Limits::max()}) {
        EXPECT_EQ(answers.deliver(t_ns, answer_of(1)), t_ns == frame_ns) << t_ns;
      }
      EXPECT_EQ(answers.counts().unknown, 2);
    }
  }
}

TEST(StampedAnswers, EndsEveryWaitWhenStopped) {
  StampedAnswers answers;
  answers.expect(100);
  std::thread other([&] { answers.stop(); });
  EXPECT_FALSE(answers.take(100, hours(1)).has_value());
  other.join();
  EXPECT_TRUE(answers.stopped());
}

TEST(StampedAnswers, RemembersABoundedNumberOfFrames) {
  StampedAnswers answers;
  for (std::int64_t t_ns = 0; t_ns < 5000; ++t_ns) answers.expect(t_ns);
  EXPECT_FALSE(answers.deliver(0, answer_of(0)));
  EXPECT_EQ(answers.counts().unknown, 1);
  EXPECT_TRUE(answers.deliver(4999, answer_of(4999)));
}

}  // namespace
}  // namespace overfly
