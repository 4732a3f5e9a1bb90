// Which flights of two sweeps are compared.
#include "server/experiments/comparison/compare_sweeps.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <optional>

#include "server/scoring/run_metrics_json.hpp"
#include "tests/support/support.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using evaluation::AlignmentMode;
using evaluation::Outcome;
using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

struct MadeFlight {
  double height_m = 0.0;
  std::optional<double> position_m;  ///< empty: it does not initialise
  Outcome outcome = Outcome::kCompleted;
  bool flown = true;  ///< false: it failed, out of memory or the like
  /// Empty: by a version that did not know it; of no use without an initialisation.
  std::optional<double> position_auc{};
};

void write_flight(const fs::path& sweep, const MadeFlight& made) {
  const std::string id = std::to_string(static_cast<int>(made.height_m));
  RunMetrics metrics;
  EstimatorMetrics& estimator = metrics.estimators["e"];
  estimator.score.outcome = made.outcome;
  if (made.position_auc) estimator.score.position_auc_limit_m = 10.0;
  if (made.position_m) {
    estimator.score.initialised_at_s = 1.0;
    auto& score = estimator.score.alignments[AlignmentMode::kSim3];
    score.mode = AlignmentMode::kSim3;
    score.position_m.rmse = *made.position_m;
    score.position_auc = made.position_auc;
    estimator.score.tracked_frames = 1;
  }
  fs::create_directories(sweep / "runs" / id);
  std::ofstream(sweep / "runs" / id / "metrics.json") << json_from(metrics);
  std::ofstream(sweep / "results.jsonl", std::ios::app)
      << nlohmann::json{{"key", id},
                        {"cell", {{"h", made.height_m}}},
                        {"repeat", 0},
                        {"seed", 1},
                        {"estimator", "e"},
                        {"run", "runs/" + id},
                        {"status", made.flown ? "completed" : "failed"},
                        {"error", made.flown ? "" : "out of memory"},
                        {"outcome", evaluation::to_string(made.outcome)},
                        {"duration_s", 1.0}}
      << "\n";
}

PairedSweeps paired(const std::vector<MadeFlight>& flights,
                    const std::vector<MadeFlight>& baseline) {
  const overfly::testing::TemporaryFolder folder;
  for (const MadeFlight& made : flights) write_flight(folder.path() / "new", made);
  for (const MadeFlight& made : baseline) write_flight(folder.path() / "old", made);
  const auto result =
      pair_sweeps(folder.path() / "new", folder.path() / "old", "", AlignmentMode::kSim3);
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message);
  return result.ok() ? *result : PairedSweeps{};
}

TEST(CompareSweeps, ALossOnAHardFlightIsNoGainOfAccuracy) {
  const PairedSweeps pairs = paired({{50, 9.0, Outcome::kLost}, {100, 1.1}, {150, 1.2}},
                                    {{50, 8.0}, {100, 1.0}, {150, 1.0}});
  EXPECT_EQ(pairs.pairs, 3U);
  EXPECT_THAT(pairs.flights.at("success_rate"), ElementsAre(1.0, 1.0, 0.0));
  EXPECT_THAT(pairs.baseline.at("success_rate"), ElementsAre(1.0, 1.0, 1.0));
  EXPECT_THAT(pairs.flights.at("position_rmse_m"), ElementsAre(1.1, 1.2));
  EXPECT_THAT(pairs.baseline.at("position_rmse_m"), ElementsAre(1.0, 1.0)) << "without 8.0";
  EXPECT_EQ(pairs.flights.at("initialised_at_s").size(), 3U);
}

TEST(CompareSweeps, TheAreaUnderTheCurveJudgesLostFlightsToo) {
  const Outcome lost = Outcome::kLost;
  const Outcome none = Outcome::kNotInitialised;
  const PairedSweeps pairs = paired({{50, 0.5, lost, true, 0.3},
                                     {100, 1.0, Outcome::kCompleted, true, 0.9},
                                     {150, std::nullopt, none, true, 0.0}},
                                    {{50, 1.0, Outcome::kCompleted, true, 0.8},
                                     {100, 1.0, Outcome::kCompleted, true, 0.7},
                                     {150, 1.0, Outcome::kCompleted, true, 0.6}});
  EXPECT_THAT(pairs.flights.at("position_auc"), UnorderedElementsAre(0.3, 0.9, 0.0));
  EXPECT_THAT(pairs.baseline.at("position_auc"), UnorderedElementsAre(0.8, 0.7, 0.6));
  // Nor does one that tracked for a moment, without an alignment, score better than none.
  const PairedSweeps moment =
      paired({{50, std::nullopt, lost, true, 0.5}}, {{50, 1.0, Outcome::kCompleted, true, 0.8}});
  EXPECT_THAT(moment.flights.at("position_auc"), UnorderedElementsAre(0.0));
  // A flight without it says nothing, also if it did not initialise.
  const PairedSweeps old = paired({{50, std::nullopt, none}, {100, 1.0}},
                                  {{50, 1.0, Outcome::kCompleted, true, 0.8}, {100, 1.0}});
  EXPECT_FALSE(old.flights.contains("position_auc"));
}

TEST(CompareSweeps, FlightsThatTheSweepNoLongerHasAreLeftOut) {
  const overfly::testing::TemporaryFolder folder;
  for (const char* name : {"new", "old"}) {
    for (const double height_m : {50.0, 100.0}) write_flight(folder.path() / name, {height_m, 1.0});
  }
  std::ofstream(folder.path() / "new" / "sweep.json") << R"({"axis_values": {"h": [100]}})";
  const auto pairs =
      pair_sweeps(folder.path() / "new", folder.path() / "old", "", AlignmentMode::kSim3);
  ASSERT_TRUE(pairs) << pairs.error().message;
  EXPECT_EQ(pairs->pairs, 1U);
  EXPECT_EQ(pairs->without_pair, 1U);
}

TEST(CompareSweeps, MissingSweepsAndEstimatorsAreNamed) {
  const overfly::testing::TemporaryFolder folder;
  const fs::path sweep = folder.path() / "new";
  write_flight(sweep, {50, 1.0});
  const auto fault = [&](const fs::path& baseline, const std::string& estimator) {
    const auto pairs = pair_sweeps(sweep, baseline, estimator, AlignmentMode::kSim3);
    EXPECT_EQ(pairs.error().code, ErrorCode::kNotFound);
    return pairs.error().message;
  };
  const fs::path run = sweep / "runs/50";
  EXPECT_EQ(fault(run, ""), run.string() + ": is no folder of a sweep (sweep.json is missing)");
  EXPECT_EQ(
      fault(folder.path() / "absent", ""),
      (folder.path() / "absent").string() + ": is no folder of a sweep (sweep.json is missing)");
  EXPECT_EQ(fault(sweep, "nobody"), sweep.string() + ": has no estimator nobody (known: e)");
  // A sweep without results is one.
  fs::create_directories(folder.path() / "fresh");
  std::ofstream(folder.path() / "fresh/sweep.json") << "{}";
  const auto fresh = pair_sweeps(sweep, folder.path() / "fresh", "e", AlignmentMode::kSim3);
  ASSERT_TRUE(fresh.ok()) << fresh.error().message;
  EXPECT_EQ(fresh->pairs, 0U);
}

TEST(CompareSweeps, FlightsWithoutAPairAndFailedOnesAreCounted) {
  const PairedSweeps pairs = paired({{50, std::nullopt, Outcome::kNotInitialised},
                                     {100, 1.0},
                                     {150, 1.0, Outcome::kCompleted, false}},
                                    {{50, 2.0}, {100, 2.0}, {150, 2.0}, {200, 2.0}});
  EXPECT_EQ(pairs.pairs, 2U);
  EXPECT_EQ(pairs.without_pair, 2U);
  EXPECT_EQ(pairs.failed, 1U);
  EXPECT_THAT(pairs.flights.at("position_rmse_m"), ElementsAre(1.0));
  EXPECT_THAT(pairs.baseline.at("position_rmse_m"), ElementsAre(2.0));
  EXPECT_EQ(pairs.baseline.at("initialised_at_s").size(), 1U);
  EXPECT_EQ(pairs.flights.at("coverage").size(), 2U);
}

}  // namespace
}  // namespace overfly::server::experiments
