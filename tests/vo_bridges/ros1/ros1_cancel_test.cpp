// Every wait for a master or a node ends when the run is cancelled.
#include <gtest/gtest.h>

#include <atomic>

#include "tests/vo_bridges/cancelled.hpp"
#include "tests/vo_bridges/ros1/ros_world.hpp"

namespace overfly::testing {
namespace {

class Ros1Cancel : public ::testing::Test {
 protected:
  Ros1Cancel() {
    options_.start_timeout_s = 600.0;
    options_.answer_timeout_s = 600.0;
    options_.cancel = &cancel_;
  }

  std::atomic<bool> cancel_ = false;
  Ros1EstimatorOptions options_ = fresh_options();
  const VoFrame frame_ = grey_frames(1).front();
};

TEST_F(Ros1Cancel, EndsTheWaitForTheMaster) {
  RosMaster::instance().stop();
  expect_cancelled_within(
      kCancelledSoonS, cancel_, [&] { return create_ros1_estimator(options_); });
}

TEST_F(Ros1Cancel, EndsTheWaitForASubscriber) {
  ROS_MASTER_OR_SKIP();
  expect_cancelled_within(
      kCancelledSoonS, cancel_, [&] { return create_ros1_estimator(options_); });
}

TEST_F(Ros1Cancel, EndsTheWaitForAReadyNode) {
  ROS_MASTER_OR_SKIP();
  Ros1EstimatorOptions elsewhere = options_;
  elsewhere.pose_topic += "/elsewhere";
  const TestNode node(elsewhere);
  const auto port = created(options_);
  expect_cancelled_within(kCancelledSoonS, cancel_, [&] { return port->prepare(frame_); });
}

TEST_F(Ros1Cancel, EndsTheWaitForAPose) {
  ROS_MASTER_OR_SKIP();
  const TestNode node(options_, {"silent_until=1000"});
  const auto port = created(options_);
  ASSERT_TRUE(port->prepare(frame_).ok());
  expect_cancelled_within(kAnswerCancelledSoonS, cancel_, [&] { return port->track(frame_); });
}

}  // namespace
}  // namespace overfly::testing
