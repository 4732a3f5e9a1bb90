// What a run records about its estimators: resource use, parameters, log lines.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "server/record/estimator_tally.hpp"
#include "server/timeline/run_timeline.hpp"
#include "tests/server/run/witness_run.hpp"

namespace overfly::server {
namespace {

using ::testing::HasSubstr;
using testing::kThree;
using testing::WitnessRun;
using Json = nlohmann::json;

TEST(EstimatorRun, ResourceUseIsInTheTimingsAndReadsBack) {
  WitnessRun flight;
  flight.overrides = {kThree};
  flight.behaviours["a"].far_end = true;
  flight.fly();
  const Json timings = flight.timings();
  const Json& outside = timings.at("estimators").at("a").at("resources");
  EXPECT_EQ(outside.at("measured"), "process");
  EXPECT_EQ(outside.at("cpu_s"), 10.5);
  EXPECT_EQ(outside.at("peak_memory_mb"), 42.0);
  const Json& native = timings.at("estimators").at("b").at("resources");
  EXPECT_EQ(native.at("measured"), "calling_thread");
  EXPECT_TRUE(native.at("peak_memory_mb").is_null());
  EXPECT_GT(native.at("cpu_s").get<double>(), 0.0);
  EXPECT_GT(timings.at("peak_memory_mb").get<double>(), 1.0);
  const auto timeline = RunTimeline::open(flight.folder.path() / "r");
  ASSERT_TRUE(timeline.ok()) << timeline.error().message;
  const std::vector<EstimatorStatus> statuses = (*timeline)->statuses();
  ASSERT_EQ(statuses.size(), 3U);
  EXPECT_EQ(statuses[0].answered, 21);
  EXPECT_EQ(statuses[0].hashes_compared, 21);
  EXPECT_EQ(state_text(statuses[0]), "TRACKING");
  ASSERT_TRUE(statuses[0].use && statuses[0].latency);
  EXPECT_EQ(*statuses[0].use->peak_memory_mb, 42.0);
  EXPECT_LE(statuses[0].latency->median_ms, statuses[0].latency->p99_ms);
}

TEST(EstimatorRun, ParametersAreReadBackAtTheEndAndAChangeIsLogged) {
  WitnessRun flight;
  flight.overrides = {R"(estimators=[{"name":"a","type":"feature"}])"};
  flight.fly();
  const Json entry = flight.manifest().at("estimators").at(0);
  EXPECT_EQ(entry.at("parameters").at("threshold"), "7");
  EXPECT_EQ(entry.at("parameters_at_end").at("threshold"), "3");
  EXPECT_EQ(entry.at("parameters_at_end").at("levels"), "8");
  const std::string log = overfly::testing::read_text(log_file(flight.folder.path() / "r"));
  EXPECT_THAT(log, HasSubstr("parameter threshold is 3 at the end, but at the start it was 7"));
  EXPECT_THAT(log, ::testing::Not(HasSubstr("levels")));
}

TEST(EstimatorRun, LinesOfAnEstimatorAreInTheLogUnderItsName) {
  WitnessRun flight;
  flight.overrides = {R"(estimators=[{"name":"a","type":"feature"}])"};
  flight.behaviours["a"].log = {"loaded the vocabulary", "error: no loop closing", "warning: slow"};
  flight.fly();
  const auto rows = read_lines(log_file(flight.folder.path() / "r"));
  ASSERT_TRUE(rows.ok());
  std::map<std::string, std::string> said;
  for (const Json& row : *rows) {
    if (row.value("source", "") == "a") said[row.at("text")] = row.at("level");
  }
  EXPECT_EQ(said.at("loaded the vocabulary"), "info");
  EXPECT_EQ(said.at("error: no loop closing"), "error");
  EXPECT_EQ(said.at("warning: slow"), "warning");
}

TEST(EstimatorRun, LogTellsNewMapsFromThoseThatAreFoundAgain) {
  WitnessRun flight;
  flight.overrides = {R"(estimators=[{"name":"a","type":"feature"}])"};
  flight.behaviours["a"].maps = {5, 5, 3, 5, 3, 8};
  flight.fly();
  const auto rows = read_lines(log_file(flight.folder.path() / "r"));
  ASSERT_TRUE(rows.ok());
  std::vector<std::string> said;
  for (const Json& row : *rows) {
    const std::string text = row.at("text");
    if (text.find(" map") != std::string::npos) said.push_back(text);
  }
  EXPECT_THAT(said,
              ::testing::ElementsAre(HasSubstr("a started a new map"),
                                     "a recovered map 5 and tracks",
                                     "a recovered map 3 and tracks",
                                     HasSubstr("a started a new map")));
}

TEST(EstimatorRun, FirstLateAnswerIsInTheLog) {
  WitnessRun flight;
  flight.overrides = {kThree};
  flight.behaviours["b"].silent = 4;
  flight.fly();
  const std::string log = overfly::testing::read_text(log_file(flight.folder.path() / "r"));
  EXPECT_THAT(log, HasSubstr("b did not answer frame 4 within answer_timeout_s"));
  EXPECT_THAT(log, ::testing::Not(HasSubstr("a did not answer")));
}

TEST(EstimatorRun, TooManyLinesAreTruncated) {
  WitnessRun flight;
  flight.overrides = {R"(estimators=[{"name":"a","type":"feature"}])"};
  flight.behaviours["a"].log.assign(5000, std::string(5000, 'x'));
  flight.fly();
  const auto rows = read_lines(log_file(flight.folder.path() / "r"));
  ASSERT_TRUE(rows.ok());
  std::vector<std::string> said;
  for (const Json& row : *rows) {
    if (row.value("source", "") == "a") said.push_back(row.at("text"));
  }
  ASSERT_EQ(said.size(), 1001U);
  EXPECT_EQ(said.front().size(), 1000U);
  EXPECT_THAT(said.back(), HasSubstr("too many lines"));
}

}  // namespace
}  // namespace overfly::server
