// Images and answers that are lost, late or double.
#include <gmock/gmock.h>

#include "tests/vo_bridges/lcm/lcm_test_estimator.hpp"

namespace overfly {
namespace {

using ::testing::Contains;
using testing::fly;
using ::testing::Ge;
using ::testing::HasSubstr;
using testing::impatient;
using testing::LcmBehaviour;
using testing::LcmPair;
using testing::make_memq_pair;
using ::testing::Pair;
using testing::varied_frames;

TEST(LcmLosses, SendsALostImageAgainInLockstep) {
  LcmBehaviour behaviour;
  behaviour.loses_image = [](const overfly_lcm::image_t& image) {
    return image.frame == 2 && image.sequence < 5;  // the first two times
  };
  const LcmPair pair = make_memq_pair(behaviour);
  const auto estimates = fly(*pair.door, 4);
  EXPECT_EQ(estimates[2].sample.state, TrackingState::kTracking);
  EXPECT_THAT(estimates[2].counters, Contains(Pair("images_lost", 2.0)));
  EXPECT_FALSE(estimates[2].counters.contains("unanswered"));
  EXPECT_FALSE(estimates[3].counters.contains("images_lost"));
  EXPECT_EQ(pair.far_end->images().size(), 4U);
}

TEST(LcmLosses, CountsALostImageInRealTimeWithoutWaiting) {
  LcmBehaviour behaviour;
  behaviour.loses_image = [](const overfly_lcm::image_t& image) { return image.frame == 2; };
  LcmEstimatorOptions options;
  options.lockstep = false;
  options.answer_timeout_s = 3600.0;
  const LcmPair pair = make_memq_pair(behaviour, options);
  const auto estimates = fly(*pair.door, 4);
  EXPECT_EQ(estimates[2].sample.state, TrackingState::kLost);
  EXPECT_THAT(estimates[2].counters, Contains(Pair("images_lost", 1.0)));
  EXPECT_THAT(estimates[2].counters, Contains(Pair("unanswered", 1.0)));
  EXPECT_EQ(estimates[3].sample.state, TrackingState::kTracking);
}

TEST(LcmLosses, GivesALostImageUpAfterSomeSends) {
  LcmBehaviour behaviour;
  behaviour.loses_image = [](const overfly_lcm::image_t& image) { return image.frame == 1; };
  const LcmPair pair = make_memq_pair(behaviour);
  const auto estimates = fly(*pair.door, 3);
  EXPECT_THAT(estimates[1].counters, Contains(Pair("images_lost", 5.0)));
  EXPECT_THAT(estimates[1].counters, Contains(Pair("unanswered", 1.0)));
  EXPECT_EQ(estimates[1].sample.state, TrackingState::kInitialising) << "no pose before";
  EXPECT_EQ(estimates[2].sample.frame, 2);
}

TEST(LcmLosses, AsksAgainForAnAnswerThatWasLost) {
  int losses = 1;
  LcmBehaviour behaviour;
  behaviour.loses_pose = [&](const overfly_lcm::pose_t& pose) {
    return pose.frame == 1 && losses-- > 0;
  };
  const LcmPair pair = make_memq_pair(behaviour);
  const auto estimates = fly(*pair.door, 2);
  EXPECT_EQ(estimates[1].sample.state, TrackingState::kTracking);
  EXPECT_EQ(pair.far_end->images().size(), 2U) << "the image came and is not sent again";
}

TEST(LcmLosses, CountsAnUnansweredFrameAndFliesOn) {
  LcmBehaviour behaviour;
  behaviour.loses_pose = [](const overfly_lcm::pose_t& pose) { return pose.frame == 2; };
  const LcmPair pair = make_memq_pair(behaviour, impatient());
  const auto estimates = fly(*pair.door, 4);
  ASSERT_EQ(estimates.size(), 4U);
  EXPECT_EQ(estimates[2].sample.state, TrackingState::kLost);
  EXPECT_THAT(estimates[2].counters, Contains(Pair("unanswered", 1.0)));
  EXPECT_EQ(estimates[3].sample.state, TrackingState::kTracking);
  EXPECT_THAT(pair.door->take_log(), Contains("no answer to frame 2 in time"));
}

TEST(LcmLosses, FailsForGoodAfterFiveFramesWithoutAWord) {
  LcmBehaviour behaviour;
  behaviour.loses_pose = [](const overfly_lcm::pose_t& pose) { return pose.frame >= 2; };
  const LcmPair pair = make_memq_pair(behaviour, impatient());
  const auto frames = varied_frames(9);
  for (int i = 0; i < 6; ++i) EXPECT_TRUE(pair.door->track(frames[i]).ok()) << i;
  const auto estimate = pair.door->track(frames[6]);
  ASSERT_FALSE(estimate.ok());
  EXPECT_EQ(estimate.error().code, ErrorCode::kInternal);
  EXPECT_THAT(estimate.error().message, HasSubstr("5 frames in a row"));
  EXPECT_FALSE(pair.door->track(frames[7]).ok());
}

TEST(LcmLosses, CountsDuplicateAndStrangeAnswers) {
  LcmBehaviour behaviour;
  behaviour.answers_each = 3;
  const LcmPair pair = make_memq_pair(behaviour);
  double duplicates = 0.0;
  for (VoEstimate& estimate : fly(*pair.door, 20)) {
    duplicates += estimate.counters["answers_duplicate"];
    EXPECT_FALSE(estimate.counters.contains("answers_unknown"));
  }
  // Those of the last frame may be on their way still.
  EXPECT_GE(duplicates, 38.0);
  EXPECT_LE(duplicates, 40.0);
}

TEST(LcmLosses, CountsAnswersToFramesThatNeverWere) {
  LcmBehaviour behaviour;
  behaviour.changes_pose = [](overfly_lcm::pose_t& pose) {
    if (pose.frame == 1) pose.t_ns += 5;
    if (pose.frame == 2) pose.session += 1;
  };
  const LcmPair pair = make_memq_pair(behaviour, impatient());
  const auto estimates = fly(*pair.door, 4);
  EXPECT_THAT(estimates[1].counters, Contains(Pair("answers_unknown", Ge(1.0))));
  EXPECT_THAT(estimates[1].counters, Contains(Pair("unanswered", 1.0)));
  EXPECT_THAT(estimates[2].counters, Contains(Pair("answers_unknown", Ge(1.0))));
  EXPECT_EQ(estimates[3].sample.state, TrackingState::kTracking);
}

}  // namespace
}  // namespace overfly
