// The margin of a flight: continuous before a failure, negative after it.
#include "server/experiments/hunt/survival_margin.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "tests/server/support/server_fixture.hpp"

namespace overfly::server::experiments {
namespace {

using evaluation::AlignmentMode;
using evaluation::Outcome;
using ::testing::HasSubstr;
using ::testing::Key;
using ::testing::UnorderedElementsAre;

/// A flight of 40 s and 1 km that succeeded: limit of the start 4 s.
FlightEvidence good_flight() {
  FlightEvidence evidence;
  evidence.score.outcome = Outcome::kCompleted;
  evidence.score.initialised_at_s = 1.0;
  evidence.score.alignments[AlignmentMode::kInitScale].position_m.rmse = 5.0;
  evidence.duration_s = 40.0;
  evidence.path_length_m = 1000.0;
  evidence.kept_share = 0.99;
  evidence.lowest_points = 300.0;
  evidence.scale_change = 1.25;
  return evidence;
}

std::map<std::string, double> factors(const FlightEvidence& evidence, const MarginRule& rule = {}) {
  std::map<std::string, double> shares;
  for (const MarginFactor& factor : margin_of(evidence, rule).factors) {
    shares[factor.name] = factor.share;
  }
  return shares;
}

TEST(SurvivalMargin, IsTheProductOfItsFactors) {
  const SurvivalMargin margin = margin_of(good_flight(), {});
  EXPECT_FALSE(margin.failed);
  EXPECT_EQ(margin.failure, "");
  const auto shares = factors(good_flight());
  EXPECT_NEAR(shares.at("tracked"), 0.8, 1e-9);         // (0.99 - 0.95) / 0.05
  EXPECT_NEAR(shares.at("start"), 0.75, 1e-9);          // 1 - 1 s / 4 s
  EXPECT_NEAR(shares.at("points"), 0.75, 1e-9);         // 300 / 400
  EXPECT_NEAR(shares.at("scale"), 0.678, 1e-3);         // 1 - log2(1.25)
  EXPECT_NEAR(shares.at("position"), 2.0 / 3.0, 1e-9);  // 1 / (1 + 0.5 % / 1 %)
  EXPECT_NEAR(margin.value, 0.8 * 0.75 * 0.75 * 0.678 * 2.0 / 3.0, 1e-3);
}

/// Each quantity that becomes worse lowers the margin before anything fails.
TEST(SurvivalMargin, FallsWithEveryQuantity) {
  const double before = margin_of(good_flight(), {}).value;
  const auto changed = [](auto change) {
    FlightEvidence evidence = good_flight();
    change(evidence);
    return margin_of(evidence, {}).value;
  };
  EXPECT_LT(changed([](auto& e) { e.kept_share = 0.97; }), before);
  EXPECT_LT(changed([](auto& e) { e.score.initialised_at_s = 2.0; }), before);
  EXPECT_LT(changed([](auto& e) { e.lowest_points = 100.0; }), before);
  EXPECT_LT(changed([](auto& e) { e.scale_change = 1.5; }), before);
  EXPECT_LT(changed([](auto& e) {
              e.score.alignments[AlignmentMode::kInitScale].position_m.rmse = 20.0;
            }),
            before);
  EXPECT_GT(changed([](auto& e) { e.scale_change = 1.99; }), 0.0);
}

TEST(SurvivalMargin, LeavesOutWhatIsNotKnown) {
  FlightEvidence evidence = good_flight();
  evidence.lowest_points.reset();
  evidence.scale_change.reset();
  evidence.score.alignments.clear();
  EXPECT_THAT(factors(evidence), UnorderedElementsAre(Key("tracked"), Key("start")));
}

TEST(SurvivalMargin, OfAFailureIsTheShareThatWasNotSurvived) {
  FlightEvidence evidence = good_flight();
  const auto value = [&](Outcome outcome, std::optional<double> time_s) {
    evidence.score.outcome = outcome;
    evidence.score.outcome_time_s = time_s;
    const SurvivalMargin margin = margin_of(evidence, {});
    EXPECT_TRUE(margin.failed);
    EXPECT_TRUE(margin.factors.empty());
    EXPECT_THAT(margin.failure, HasSubstr(evaluation::to_string(outcome)));
    return margin.value;
  };
  EXPECT_NEAR(value(Outcome::kLost, 30.0), -0.25, 1e-9);
  EXPECT_NEAR(value(Outcome::kDiverged, 10.0), -0.75, 1e-9);
  EXPECT_NEAR(value(Outcome::kNotInitialised, std::nullopt), -1.0, 1e-9);
  EXPECT_LT(value(Outcome::kLost, 40.0), 0.0) << "at the very end";
  evidence.score.initialised_at_s = 6.0;
  EXPECT_NEAR(value(Outcome::kInitLate, 6.0), -0.15, 1e-9);
  evidence.score.outcome = Outcome::kLost;
  evidence.score.outcome_time_s = 12.34;
  EXPECT_EQ(margin_of(evidence, {}).failure, "LOST at 12.3 s");
}

TEST(SurvivalMargin, AnErrorBeyondTheLimitIsAFailure) {
  MarginRule rule;
  rule.position_rmse_limit_m = 4.0;
  const SurvivalMargin beyond = margin_of(good_flight(), rule);
  EXPECT_TRUE(beyond.failed);
  EXPECT_NEAR(beyond.value, -0.2, 1e-9);  // 1 - 4 / 5
  EXPECT_EQ(beyond.failure, "position RMSE 5 m");
  rule.position_rmse_limit_m = 10.0;
  EXPECT_NEAR(factors(good_flight(), rule).at("position"), 0.5, 1e-9);
  rule.alignment = AlignmentMode::kSim3;  // not available in this flight
  EXPECT_FALSE(factors(good_flight(), rule).contains("position"));
}

TEST(SurvivalMargin, ReadsItsEvidenceFromARun) {
  const overfly::testing::TemporaryFolder folder;
  const auto scenario =
      server::testing::small_scenario({R"(estimators=[{"name":"p","type":"perfect"}])"});
  ASSERT_TRUE(run_scenario(scenario, server::testing::options_for(folder.path() / "run")).ok());
  const auto evidence = read_evidence(folder.path() / "run", "p");
  ASSERT_TRUE(evidence.ok()) << evidence.error().message;
  EXPECT_EQ(evidence->score.outcome, Outcome::kCompleted);
  EXPECT_NEAR(evidence->duration_s, 1.9, 0.2);
  EXPECT_GT(evidence->path_length_m, 10.0);
  EXPECT_DOUBLE_EQ(evidence->kept_share, 1.0);
  EXPECT_FALSE(evidence->lowest_points.has_value()) << "it reports none";
  EXPECT_FALSE(evidence->scale_change.has_value()) << "shorter than a window of 10 s";
  EXPECT_GT(margin_of(*evidence, {}).value, 0.9);
  EXPECT_EQ(read_evidence(folder.path() / "run", "q").error().code, ErrorCode::kNotFound);
}

}  // namespace
}  // namespace overfly::server::experiments
