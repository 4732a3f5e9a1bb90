// Estimators that fail: the server continues and reports what happened.
#include <gmock/gmock.h>

#include <map>

#include "tests/support/support.hpp"
#include "tests/vo_bridges/process/process_fixture.hpp"
#include "vo_bridges/pose_intake.hpp"

namespace overfly {
namespace {

using testing::alive;
using ::testing::AllOf;
using testing::ChildrenTest;
using testing::gone_soon;
using testing::ground_frames;
using ::testing::HasSubstr;
using testing::python_estimator;
using testing::scripted;
using testing::started;

class ProcessTrouble : public ChildrenTest {
 protected:
  /// The error of the frame after three that went well or not.
  static Error flight_error(const ProcessEstimatorOptions& options, bool debug = false) {
    const auto estimator = started(options);
    if (!estimator) return {};
    estimator->set_debug(debug);
    for (const VoFrame& frame : ground_frames(6, 1.0, 1.0, 64, 48)) {
      const Result<VoEstimate> estimate = estimator->track(frame);
      if (estimate) continue;
      VoFrame next = frame;
      next.index += 1;
      next.t_ns += 1'000'000;
      EXPECT_EQ(estimator->track(next).error().message, estimate.error().message)
          << "the reason stays";
      return estimate.error();
    }
    ADD_FAILURE() << "every frame was answered";
    return {};
  }
};

TEST_F(ProcessTrouble, ACrashIsToldWithTheLastWords) {
  const testing::TemporaryFolder folder;
  ProcessEstimatorOptions options = scripted("crash");
  options.output_file = folder.path() / "output.log";
  const Error error = flight_error(options);
  EXPECT_EQ(error.code, ErrorCode::kInternal);
  EXPECT_THAT(error.message,
              AllOf(HasSubstr("estimator scripted"),
                    HasSubstr("killed by signal 6"),
                    HasSubstr("matching 17 features"),
                    HasSubstr("Segfault ahead, by ? design")));
  EXPECT_THAT(testing::read_text(options.output_file), HasSubstr("Segfault ahead, by \xFF design"));
}

TEST_F(ProcessTrouble, AnEndIsToldWithItsCode) {
  EXPECT_THAT(flight_error(scripted("quit")).message, HasSubstr("exited with code 3"));
  EXPECT_THAT(flight_error(scripted("throw")).message,
              AllOf(HasSubstr("exited with code 1"), HasSubstr("error: the map is empty")));
}

TEST_F(ProcessTrouble, BadAnswersEndTheFlightAndAreQuoted) {
  EXPECT_THAT(flight_error(scripted("bad_state")).message, HasSubstr("state = 7"));
  EXPECT_THAT(flight_error(scripted("large_debug_image"), true).message,
              HasSubstr("DEBUG_IMAGE is 64 x 9999 px"));
}

TEST_F(ProcessTrouble, APoseThatIsNoneIsOneLostFrameWithAWarning) {
  for (const auto& [behaviour, complaint] : std::map<std::string, std::string>{
           {"nan_pose", "frame 2: the position is not finite"},
           {"long_quaternion", "frame 2: the quaternion's norm is"}}) {
    const auto estimator = started(scripted(behaviour, "2"));
    for (const VoFrame& frame : ground_frames(4, 1.0, 1.0, 64, 48)) {
      const Result<VoEstimate> estimate = estimator->track(frame);
      ASSERT_TRUE(estimate.ok()) << estimate.error().message;
      if (frame.index == 0) continue;
      EXPECT_EQ(estimate->sample.state,
                frame.index == 2 ? TrackingState::kLost : TrackingState::kTracking);
    }
    EXPECT_THAT(lines_with(*estimator, "warning: " + complaint), ::testing::SizeIs(1));
  }
}

TEST_F(ProcessTrouble, ManyPosesThatAreNoneEndTheFlight) {
  const auto estimator = started(scripted("nan_pose", "all"));
  const auto frames = ground_frames(PoseIntake::kMostInARow + 2, 1.0, 1.0, 64, 48);
  // The first frame of a scripted estimator claims no pose.
  for (int i = 0; i < PoseIntake::kMostInARow; ++i) {
    EXPECT_TRUE(estimator->track(frames[static_cast<std::size_t>(i)]).ok()) << i;
  }
  const Result<VoEstimate> gone = estimator->track(frames[PoseIntake::kMostInARow]);
  ASSERT_FALSE(gone.ok());
  EXPECT_EQ(gone.error().code, ErrorCode::kInternal);
  EXPECT_THAT(gone.error().message,
              AllOf(HasSubstr("30 answers in a row had no usable pose"),
                    HasSubstr("for frame 30: the position is not finite"),
                    HasSubstr("its last output: camera0 64x48")));
}

TEST_F(ProcessTrouble, TheLastWordsAreItsOwnAndNotThoseAboutItsEnd) {
  const testing::TemporaryFolder folder;
  // A lost connection would end it with a traceback of many lines.
  ProcessEstimatorOptions options = python_estimator(
      "    def track(self, frame):\n"
      "        print('the map is empty', file=sys.stderr, flush=True)\n"
      "        return overfly_vo.Answer(state=7)\n",
      folder.path());
  options.output_file = folder.path() / "output.log";
  const auto estimator = started(options);
  const Result<VoEstimate> answer = estimator->track(ground_frames(1, 1.0, 1.0, 64, 48)[0]);
  ASSERT_FALSE(answer.ok());
  EXPECT_THAT(answer.error().message, ::testing::EndsWith("; its last output: the map is empty"));
  EXPECT_EQ(testing::read_text(options.output_file), "the map is empty\n");
}

TEST_F(ProcessTrouble, AFloodOfMessagesEndsTheFlight) {
  EXPECT_THAT(flight_error(scripted("flood")).message,
              AllOf(HasSubstr("floods"), HasSubstr("and another thing")));
}

TEST_F(ProcessTrouble, AFloodOfOutputIsCutInTheFileAndTheFlightGoesOn) {
  const testing::TemporaryFolder folder;
  ProcessEstimatorOptions options = scripted("shout");
  options.output_file = folder.path() / "output.log";
  const auto estimator = started(options);
  for (const VoFrame& frame : ground_frames(4, 1.0, 1.0, 64, 48)) {
    ASSERT_TRUE(estimator->track(frame).ok());
  }
  EXPECT_GT(std::filesystem::file_size(options.output_file), 64'000'000U);
  EXPECT_LT(std::filesystem::file_size(options.output_file), 64'000'100U);
  EXPECT_LE(estimator->take_log().size(), 2001U);
}

TEST_F(ProcessTrouble, ALateAnswerLosesOneFrame) {
  ProcessEstimatorOptions options = scripted("late", "1.5");
  options.answer_timeout_s = 1.0;
  const auto estimator = started(options);
  std::vector<VoEstimate> estimates;
  for (const VoFrame& frame : ground_frames(5, 1.0, 1.0, 64, 48)) {
    estimates.push_back(estimator->track(frame).value());
  }
  EXPECT_EQ(estimates[1].sample.state, TrackingState::kTracking);
  EXPECT_EQ(estimates[2].sample.state, TrackingState::kLost);
  EXPECT_EQ(estimates[2].sample.frame, 2);
  EXPECT_EQ(estimates[2].counters.at("unanswered"), 1.0);
  for (const std::size_t i : {3U, 4U}) {
    EXPECT_EQ(estimates[i].sample.state, TrackingState::kTracking);
    EXPECT_EQ(estimates[i].sample.T_vo_camera.translation.x(), static_cast<double>(i))
        << "the pose is that of its own frame";
    EXPECT_EQ(estimates[i].counters.count("unanswered"), 0U);
  }
}

TEST_F(ProcessTrouble, AHangingEstimatorIsGivenUpAfterThreeTimeouts) {
  ProcessEstimatorOptions options = scripted("hang");
  options.answer_timeout_s = 0.5;
  const auto estimator = started(options);
  std::vector<Result<VoEstimate>> estimates;
  for (const VoFrame& frame : ground_frames(6, 1.0, 1.0, 64, 48)) {
    estimates.push_back(estimator->track(frame));
  }
  const int pid = static_cast<int>(estimates[0]->counters.at("pid"));
  for (const std::size_t i : {2U, 3U}) {
    ASSERT_TRUE(estimates[i].ok());
    EXPECT_EQ(estimates[i]->sample.state, TrackingState::kLost);
  }
  ASSERT_FALSE(estimates[4].ok());
  EXPECT_EQ(estimates[4].error().code, ErrorCode::kTimeout);
  EXPECT_THAT(estimates[4].error().message,
              HasSubstr("hangs: frame 2 was not answered within 1.5 s; its last output: camera0"));
  EXPECT_FALSE(estimates[5].ok());
  EXPECT_FALSE(alive(pid));
}

TEST_F(ProcessTrouble, AStopHearsTheAnswerThatIsUnderWay) {
  const testing::TemporaryFolder folder;
  ProcessEstimatorOptions options = scripted("late", "1.3");
  options.answer_timeout_s = 1.0;
  options.output_file = folder.path() / "output.log";
  {
    const auto estimator = started(options);
    estimator->set_debug(true);
    // An image that the socket does not hold: it must be read to its end.
    for (const VoFrame& frame : ground_frames(3, 1.0, 1.0, 640, 480)) {
      ASSERT_TRUE(estimator->track(frame).ok());
    }
  }
  EXPECT_EQ(testing::read_text(options.output_file), "") << "it was not cut off";
}

}  // namespace
}  // namespace overfly
