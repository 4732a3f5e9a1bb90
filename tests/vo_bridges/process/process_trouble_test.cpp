// Estimators that fail: the server goes on, says what happened, and nothing is left of them.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <functional>
#include <map>
#include <set>
#include <thread>

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

  /// Of the lines of its log those that hold `part`.
  static std::vector<std::string> lines_with(VoPort& estimator, const std::string& part) {
    std::vector<std::string> lines;
    for (const std::string& line : estimator.take_log()) {
      if (line.find(part) != std::string::npos) lines.push_back(line);
    }
    return lines;
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
                    HasSubstr("it last said: camera0 64x48")));
}

TEST_F(ProcessTrouble, TheLastWordsAreItsOwnAndNotThoseAboutItsEnd) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "estimator.py";
  // A lost connection would end it with a traceback of many lines.
  testing::write_text(file,
                      "import sys\n"
                      "sys.path.insert(0, sys.argv[1])\n"
                      "import overfly_vo\n"
                      "class Odd(overfly_vo.Estimator):\n"
                      "    def track(self, frame):\n"
                      "        print('the map is empty', file=sys.stderr, flush=True)\n"
                      "        return overfly_vo.Answer(state=7)\n"
                      "overfly_vo.run(Odd())\n");
  ProcessEstimatorOptions options = scripted("good");
  options.command = {
      "python3", "-B", file.string(), testing::source_file("vo_bridges/client").string()};
  options.output_file = folder.path() / "output.log";
  const auto estimator = started(options);
  const Result<VoEstimate> answer = estimator->track(ground_frames(1, 1.0, 1.0, 64, 48)[0]);
  ASSERT_FALSE(answer.ok());
  EXPECT_THAT(answer.error().message, ::testing::EndsWith("; it last said: the map is empty"));
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
  EXPECT_EQ(estimates[4].error().code, ErrorCode::kInternal);
  EXPECT_THAT(estimates[4].error().message,
              HasSubstr("hangs: frame 2 was not answered within 1.5 s; it last said: camera0"));
  EXPECT_FALSE(estimates[5].ok());
  EXPECT_FALSE(alive(pid));
}

TEST_F(ProcessTrouble, AHangInAResetIsToldWithTheNextFrame) {
  ProcessEstimatorOptions options = scripted("hang_in_reset");
  options.answer_timeout_s = 1.0;
  const auto estimator = started(options);
  const auto frames = ground_frames(2, 1.0, 1.0, 64, 48);
  ASSERT_TRUE(estimator->track(frames[0]).ok());
  estimator->reset();
  EXPECT_THAT(estimator->track(frames[1]).error().message, HasSubstr("not ready after RESET"));
}

TEST_F(ProcessTrouble, AResetPassesOverTheAnswerThatIsUnderWay) {
  ProcessEstimatorOptions options = scripted("late", "1.3");
  options.answer_timeout_s = 1.0;
  const auto estimator = started(options);
  estimator->set_debug(true);  // the answer comes with an image
  const auto frames = ground_frames(3, 1.0, 1.0, 64, 48);
  for (const VoFrame& frame : frames) ASSERT_TRUE(estimator->track(frame).ok());
  estimator->reset();  // while frame 2 is still being thought about
  const VoEstimate estimate = estimator->track(frames[1]).value();
  EXPECT_EQ(estimate.counters.count("unanswered"), 0U);
  EXPECT_EQ(estimate.sample.frame, 1);
  EXPECT_EQ(estimate.counters.at("calibrations"), 1.0) << "the same camera is not told again";
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

TEST_F(ProcessTrouble, FiguresThatAreNotFiniteAreLeftOutWithOneWarning) {
  const auto estimator = started(scripted("nan_figures"));
  for (const VoFrame& frame : ground_frames(3, 1.0, 1.0, 64, 48)) {
    const Result<VoEstimate> estimate = estimator->track(frame);
    ASSERT_TRUE(estimate.ok()) << estimate.error().message;
    EXPECT_EQ(estimate->counters.count("parallax"), 0U);
    EXPECT_EQ(estimate->timing_ms, (std::map<std::string, double>{{"match", 1.5}}));
  }
  EXPECT_EQ(lines_with(*estimator, "not finite"),
            (std::vector<std::string>{"warning: counter parallax is not finite: this and later "
                                      "such values are ignored"}));
}

TEST_F(ProcessTrouble, FiguresOfPythonThatAreNotFiniteAreLeftOutWithOneWarning) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "estimator.py";
  testing::write_text(file,
                      "import sys\n"
                      "sys.path.insert(0, sys.argv[1])\n"
                      "import overfly_vo\n"
                      "class Odd(overfly_vo.Estimator):\n"
                      "    def track(self, frame):\n"
                      "        return overfly_vo.Answer(\n"
                      "            counters={'a': float('nan'), 'b': 2},\n"
                      "            timings_ms={'c': float('-inf'), 'd': 0.5})\n"
                      "overfly_vo.run(Odd())\n");
  ProcessEstimatorOptions options = scripted("good");
  options.command = {
      "python3", "-B", file.string(), testing::source_file("vo_bridges/client").string()};
  const auto estimator = started(options);
  for (const VoFrame& frame : ground_frames(3, 1.0, 1.0, 64, 48)) {
    const Result<VoEstimate> estimate = estimator->track(frame);
    ASSERT_TRUE(estimate.ok()) << estimate.error().message;
    EXPECT_EQ(estimate->counters, (std::map<std::string, double>{{"b", 2.0}}));
    EXPECT_EQ(estimate->timing_ms, (std::map<std::string, double>{{"d", 0.5}}));
  }
  EXPECT_THAT(lines_with(*estimator, "not finite"), ::testing::SizeIs(1));
}

TEST_F(ProcessTrouble, NamesWithoutEndAreCutWithOneWarningForEachKind) {
  const auto estimator = started(scripted("many_names"));
  std::set<std::string> counters;
  std::set<std::string> timings;
  for (const VoFrame& frame : ground_frames(6, 1.0, 1.0, 64, 48)) {
    const Result<VoEstimate> estimate = estimator->track(frame);
    ASSERT_TRUE(estimate.ok()) << estimate.error().message;
    EXPECT_EQ(estimate->timing_ms.at("match"), 1.5) << "a name that was there goes on";
    for (const auto& [name, value] : estimate->counters) counters.insert(name);
    for (const auto& [name, value] : estimate->timing_ms) timings.insert(name);
  }
  EXPECT_EQ(counters.size(), 256U);
  EXPECT_EQ(timings.size(), 256U);
  EXPECT_EQ(estimator->effective_parameters().size(), 4096U);
  EXPECT_THAT(lines_with(*estimator, "exceeds the limit"),
              ::testing::UnorderedElementsAre(
                  AllOf(HasSubstr("warning: counter c"), HasSubstr("limit of 256")),
                  AllOf(HasSubstr("warning: timing_ms t"), HasSubstr("limit of 256")),
                  AllOf(HasSubstr("warning: parameter p"), HasSubstr("limit of 4096"))));
}

TEST_F(ProcessTrouble, AChildThatDoesNotStopIsKilled) {
  int pid = 0;
  const double took_s = seconds_of([&] {
    const auto estimator = started(scripted("stubborn"));
    const auto frames = ground_frames(1, 1.0, 1.0, 64, 48);
    pid = static_cast<int>(estimator->track(frames[0])->counters.at("pid"));
  });
  EXPECT_FALSE(alive(pid));
  EXPECT_GT(took_s, 2.5) << "it was given time";
  EXPECT_LT(took_s, 10.0);
}

TEST_F(ProcessTrouble, GrandchildrenDieWithTheChild) {
  int grandchild = 0;
  {
    const auto estimator = started(scripted("grandchild"));
    for (const VoFrame& frame : ground_frames(4, 1.0, 1.0, 64, 48)) {
      grandchild = static_cast<int>(estimator->track(frame)->counters.at("child"));
    }
    ASSERT_GT(grandchild, 0);
    EXPECT_TRUE(alive(grandchild));
  }
  EXPECT_TRUE(gone_soon(grandchild));
}

TEST_F(ProcessTrouble, GrandchildrenThatCutThemselvesLooseDieWithTheChild) {
  const auto daemon_of = [](VoPort& estimator) {
    int daemon = 0;
    for (const VoFrame& frame : ground_frames(4, 1.0, 1.0, 64, 48)) {
      daemon = static_cast<int>(estimator.track(frame)->counters.at("child"));
    }
    EXPECT_GT(daemon, 0);
    EXPECT_TRUE(alive(daemon));
    return daemon;
  };
  auto one = started(scripted("loose_grandchild"));
  auto other = started(scripted("loose_grandchild"));
  const int of_one = daemon_of(*one);
  const int of_other = daemon_of(*other);
  one.reset();
  EXPECT_FALSE(alive(of_one));
  EXPECT_TRUE(alive(of_other)) << "another estimator's";
  other.reset();
  EXPECT_FALSE(alive(of_other));
}

TEST_F(ProcessTrouble, TemporaryFilesGoIntoAFolderOfItsOwnAndAreRemoved) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "estimator.py";
  testing::write_text(file,
                      "import os, sys, tempfile\n"
                      "sys.path.insert(0, sys.argv[1])\n"
                      "import overfly_vo\n"
                      "class Writer(overfly_vo.Estimator):\n"
                      "    def track(self, frame):\n"
                      "        os.makedirs(os.path.join(tempfile.gettempdir(), 'a', 'b'))\n"
                      "        self.log(1, tempfile.gettempdir())\n"
                      "        return overfly_vo.Answer()\n"
                      "overfly_vo.run(Writer())\n");
  ProcessEstimatorOptions options = scripted("good");
  options.command = {
      "python3", "-B", file.string(), testing::source_file("vo_bridges/client").string()};
  const VoFrame frame = ground_frames(1, 1.0, 1.0, 64, 48)[0];
  std::set<std::filesystem::path> folders;
  {
    const auto one = started(options);
    const auto other = started(options);
    for (VoPort* estimator : {one.get(), other.get()}) {
      ASSERT_TRUE(estimator->track(frame).ok()) << "the name is not taken";
      for (const std::string& line : lines_with(*estimator, "overfly-vo-")) folders.insert(line);
    }
    ASSERT_EQ(folders.size(), 2U);
    for (const std::filesystem::path& its : folders) {
      EXPECT_TRUE(std::filesystem::is_directory(its / "a" / "b")) << its;
    }
  }
  for (const std::filesystem::path& its : folders) EXPECT_FALSE(std::filesystem::exists(its));
}

TEST_F(ProcessTrouble, AKilledServerLeavesNoOrphan) {
  std::array<int, 2> told{};
  ASSERT_EQ(::pipe(told.data()), 0);
  const pid_t server = ::fork();
  if (server == 0) {
    const auto estimator = started(scripted("stubborn"));
    const auto frames = ground_frames(1, 1.0, 1.0, 64, 48);
    const int pid = static_cast<int>(estimator->track(frames[0])->counters.at("pid"));
    [[maybe_unused]] const ssize_t written = ::write(told[1], &pid, sizeof(pid));
    for (;;) ::pause();
  }
  int pid = 0;
  ::close(told[1]);
  ASSERT_EQ(::read(told[0], &pid, sizeof(pid)), static_cast<ssize_t>(sizeof(pid)));
  ::close(told[0]);
  EXPECT_TRUE(alive(pid));
  ::kill(server, SIGKILL);
  ::waitpid(server, nullptr, 0);
  EXPECT_TRUE(gone_soon(pid));
  ::waitpid(pid, nullptr, 0);  // ours now: earlier children made this process their subreaper
}

}  // namespace
}  // namespace overfly
