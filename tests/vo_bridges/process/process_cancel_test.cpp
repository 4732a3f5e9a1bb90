// Every wait for an estimator ends when the run is cancelled.
#include <gmock/gmock.h>

#include <atomic>

#include "tests/support/support.hpp"
#include "tests/vo_bridges/cancelled.hpp"
#include "tests/vo_bridges/process/process_fixture.hpp"

namespace overfly {
namespace {

using testing::alive;
using testing::cancelled;
using testing::expect_cancelled_within;
using testing::ground_frames;
using testing::kAnswerCancelledSoonS;
using testing::kCancelledSoonS;
using testing::scripted;
using testing::started;

class ProcessCancel : public testing::ChildrenTest {
 protected:
  ProcessEstimatorOptions cancelled_by_us(ProcessEstimatorOptions options) {
    options.cancel = &cancel_;
    return options;
  }

  std::atomic<bool> cancel_ = false;
  const std::vector<VoFrame> frames_ = ground_frames(4, 1.0, 1.0, 64, 48);
};

TEST_F(ProcessCancel, EndsTheWaitForAConnection) {
  const testing::TemporaryFolder folder;
  ProcessEstimatorOptions options = cancelled_by_us({});
  options.listen = "unix:" + (folder.path() / "socket").string();
  expect_cancelled_within(
      kCancelledSoonS, cancel_, [&] { return create_process_estimator(options); });
}

TEST_F(ProcessCancel, EndsTheWaitForAStart) {
  const ProcessEstimatorOptions options = cancelled_by_us(scripted("slow_start"));
  const Error error = expect_cancelled_within(
      kCancelledSoonS, cancel_, [&] { return create_process_estimator(options); });
  EXPECT_EQ(error.message, "estimator scripted: stopped while waiting for the estimator");
}

TEST_F(ProcessCancel, EndsTheWaitForACalibration) {
  const auto estimator = started(cancelled_by_us(scripted("slow_calibration")));
  expect_cancelled_within(kCancelledSoonS, cancel_, [&] { return estimator->prepare(frames_[0]); });
}

TEST_F(ProcessCancel, EndsTheWaitForAnAnswer) {
  const auto estimator = started(cancelled_by_us(scripted("hang")));
  ASSERT_TRUE(estimator->track(frames_[0]).ok());
  const int pid = static_cast<int>(estimator->track(frames_[1])->counters.at("pid"));
  expect_cancelled_within(
      kAnswerCancelledSoonS, cancel_, [&] { return estimator->track(frames_[2]); });
  EXPECT_FALSE(alive(pid));
  EXPECT_EQ(estimator->track(frames_[3]).error().code, ErrorCode::kCancelled) << "for good";
}

TEST_F(ProcessCancel, LeavesAnEstimatorThatWorksItsAnswer) {
  const auto estimator = started(cancelled_by_us(scripted("late", "0.6")));
  ASSERT_TRUE(estimator->track(frames_[0]).ok());
  ASSERT_TRUE(estimator->track(frames_[1]).ok());
  const auto answer = cancelled(cancel_, [&] { return estimator->track(frames_[2]); }).outcome;
  ASSERT_TRUE(answer.ok()) << answer.error().message;
}

}  // namespace
}  // namespace overfly
