// Estimators that give invalid answers, do not start or end during the run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "server/record/estimator_tally.hpp"
#include "server/timeline/run_timeline.hpp"
#include "tests/server/run/witness_run.hpp"
#include "vo_bridges/pose_intake.hpp"

namespace overfly::server {
namespace {

using overfly::testing::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::kThree;
using testing::WitnessRun;
using Json = nlohmann::json;

/// JSON has no text for values that are not finite.
TEST(EstimatorRun, AnswersThatAreNotFiniteLeaveTheFolderReadable) {
  WitnessRun flight;
  flight.overrides = {R"(estimators=[{"name":"a","type":"feature"}])"};
  flight.behaviours["a"].not_finite = 6;
  flight.fly();
  const RunRecords records = flight.records();
  const EstimateRecord& record = records.estimators[0].records.at(6);
  EXPECT_EQ(record.sample.frame, 6);
  EXPECT_EQ(record.sample.state, TrackingState::kLost);
  EXPECT_FALSE(record.sample.scene_depth.has_value());
  EXPECT_EQ(record.counters, (std::map<std::string, double>{{"inliers", 3.0}}));
  EXPECT_EQ(records.estimators[0].records.at(7).sample.state, TrackingState::kTracking);
  EXPECT_THAT(overfly::testing::read_text(log_file(flight.folder.path() / "r")),
              HasSubstr("warning: frame 6: the position is not finite"));
}

TEST(EstimatorRun, OneWithoutAUsablePoseForLongCountsAsCrashed) {
  WitnessRun flight;
  flight.overrides = {"duration_s=5", R"(estimators=[{"name":"a","type":"feature"}])"};
  flight.behaviours["a"].not_finite = 6;
  flight.behaviours["a"].not_finite_from_there = true;
  const RunResult run = flight.fly();
  const EstimatorMetrics& score = run.metrics.estimators.at("a");
  EXPECT_EQ(score.score.outcome, evaluation::Outcome::kCrashed);
  EXPECT_EQ(score.score.outcome_time_s, 0.1 * (6 + PoseIntake::kMostInARow - 1));
  EXPECT_THAT(score.crash.value_or(""), HasSubstr("30 answers in a row had no usable pose"));
}

TEST(EstimatorRun, OneThatHangsHasTheOutcomeTimeout) {
  WitnessRun flight;
  flight.overrides = {R"(estimators=[{"name":"a","type":"feature"}])"};
  flight.behaviours["a"].hangs = 9;
  const RunResult run = flight.fly();
  const EstimatorMetrics& score = run.metrics.estimators.at("a");
  EXPECT_EQ(score.score.outcome, evaluation::Outcome::kTimeout);
  EXPECT_EQ(score.score.outcome_time_s, 0.9);
  EXPECT_EQ(score.crash, "it hangs");
  EXPECT_TRUE(flight.records().estimators[0].records.at(9).hung);
}

TEST(EstimatorRun, OneThatDoesNotStartIsCrashedAndTheOthersFly) {
  const TemporaryFolder folder;
  RunOptions options;
  options.folder = folder.path() / "r";
  options.renderer_factory = testing::noop_factory();
  const auto run = run_scenario(
      testing::small_scenario(
          {R"(estimators=[{"name":"gone","type":"process","command":["/nowhere/at-all"]},)"
           R"({"name":"p","type":"perfect"}])"}),
      options);
  ASSERT_TRUE(run.ok()) << run.error().message;
  EXPECT_EQ(run->info.status, RunStatus::kCompleted);
  const auto& scores = run->metrics.estimators;
  EXPECT_EQ(scores.at("gone").score.outcome, evaluation::Outcome::kCrashed);
  EXPECT_EQ(scores.at("p").score.outcome, evaluation::Outcome::kCompleted);
  const Json manifest = read_json(manifest_file(options.folder)).value();
  EXPECT_THAT(manifest.at("estimators").at(0).at("start_error").get<std::string>(),
              HasSubstr("/nowhere/at-all"));
  EXPECT_FALSE(manifest.at("estimators").at(1).contains("start_error"));
  const auto timeline = RunTimeline::open(options.folder);
  ASSERT_TRUE(timeline.ok());
  const EstimatorStatus status = (*timeline)->statuses().at(0);
  EXPECT_EQ(state_text(status), "CRASHED");
  EXPECT_THAT(status.crash, AllOf(HasSubstr("did not start"), HasSubstr("/nowhere/at-all")));
  EXPECT_EQ(status.answered, 0);
  EXPECT_FALSE(status.latency.has_value());
  EXPECT_THAT(overfly::testing::read_text(log_file(options.folder)),
              ::testing::Not(HasSubstr("gone lost track")));
}

TEST(EstimatorRun, OneThatDoesNotGetReadyIsCrashedAndTheOthersFly) {
  WitnessRun flight;
  flight.overrides = {kThree};
  flight.behaviours["b"].unready = "no vocabulary";
  const RunResult run = flight.fly();
  EXPECT_EQ(run.metrics.estimators.at("b").score.outcome, evaluation::Outcome::kCrashed);
  EXPECT_EQ(run.metrics.estimators.at("a").score.outcome, evaluation::Outcome::kCompleted);
  EXPECT_TRUE(flight.seen["b"].empty());
  EXPECT_EQ(flight.records().estimators[1].records[0].crash, "no vocabulary");
}

TEST(EstimatorRun, OneThatIsStoppedInAFrameHasNotCrashed) {
  WitnessRun flight;
  flight.overrides = {R"(estimators=[{"name":"a","type":"feature"}])"};
  flight.behaviours["a"].cancelled = 20;  // the last
  const RunResult run = flight.fly();
  EXPECT_EQ(run.metrics.estimators.at("a").score.outcome, evaluation::Outcome::kCompleted);
  EXPECT_EQ(run.metrics.estimators.at("a").dropped_frames, 1);
}

TEST(EstimatorRun, AMissingProcessorIsAnError) {
  const TemporaryFolder folder;
  RunOptions options;
  options.folder = folder.path() / "r";
  options.renderer_factory = testing::noop_factory();
  const auto run = run_scenario(
      testing::small_scenario({R"(estimators=[{"name":"p","type":"perfect","cpus":[1023]}])"}),
      options);
  ASSERT_FALSE(run.ok());
  EXPECT_THAT(run.error().message, AllOf(HasSubstr("\"p\""), HasSubstr("cpus = [1023]")));
}

}  // namespace
}  // namespace overfly::server
