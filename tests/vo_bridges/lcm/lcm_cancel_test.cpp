// Every wait for an estimator ends when the run is cancelled.
#include <gtest/gtest.h>

#include <atomic>

#include "tests/vo_bridges/cancelled.hpp"
#include "tests/vo_bridges/lcm/lcm_test_estimator.hpp"

namespace overfly::testing {
namespace {

class LcmCancel : public ::testing::Test {
 protected:
  LcmCancel() {
    options_.start_timeout_s = 60.0;
    options_.answer_timeout_s = 60.0;
    options_.cancel = &cancel_;
  }

  std::atomic<bool> cancel_ = false;
  LcmEstimatorOptions options_;
  LcmBehaviour behaviour_;
  const std::vector<VoFrame> frames_ = varied_frames(2);
};

TEST_F(LcmCancel, EndsTheWaitForAnEstimatorToBePrepared) {
  behaviour_.calibrations_missed = 1000;
  const LcmPair pair = make_memq_pair(behaviour_, options_);
  expect_cancelled_within(kCancelledSoonS, cancel_, [&] { return pair.door->prepare(frames_[0]); });
}

TEST_F(LcmCancel, EndsTheWaitForAnEstimatorInTheFirstFrame) {
  behaviour_.calibrations_missed = 1000;
  const LcmPair pair = make_memq_pair(behaviour_, options_);
  expect_cancelled_within(kCancelledSoonS, cancel_, [&] { return pair.door->track(frames_[0]); });
}

TEST_F(LcmCancel, EndsTheWaitForAnAnswer) {
  behaviour_.loses_pose = [](const overfly_lcm::pose_t& pose) { return pose.frame == 1; };
  const LcmPair pair = make_memq_pair(behaviour_, options_);
  ASSERT_TRUE(pair.door->track(frames_[0]).ok());
  expect_cancelled_within(
      kAnswerCancelledSoonS, cancel_, [&] { return pair.door->track(frames_[1]); });
}

}  // namespace
}  // namespace overfly::testing
