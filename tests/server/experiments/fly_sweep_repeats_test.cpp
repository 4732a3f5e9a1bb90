// Repeats of a sweep's cells: when they stop, and what becomes of those that are not needed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/experiments/fly_sweep.hpp"
#include "server/experiments/sweep_summary.hpp"
#include "tests/server/experiments/fly_sweep_fixture.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using overfly::testing::read_text;
using overfly::testing::write_text;
using ::testing::HasSubstr;

/// With a success rate of 1 the interval's half-width is z^2 / (2 (n + z^2)): 0.162 at 8 flights,
/// 0.150 at 9.
TEST_F(FlySweep, RepeatsStopWhenTheRateIsKnown) {
  write_program();
  const auto flown = fly(sweep(R"("axes": [], "repeats": {"most": 20, "half_width": 0.15})"), 2);
  ASSERT_TRUE(flown.ok()) << flown.error().message;
  EXPECT_EQ(flights(), 9U);
  EXPECT_EQ(progress_.passed, 20U) << "the others need not be flown";
  const auto rows = summary_of(*flown, folder(), evaluation::AlignmentMode::kSim3);
  EXPECT_EQ(rows[0].flights, 9);
  EXPECT_NEAR(rows[0].success_interval.low, 9.0 / (9.0 + 3.841458820694124), 1e-12);
}

/// The same cells and repeats with another seed of the scenario: the rate of the first is known
/// after 20 flights, that of the second after 9.
TEST_F(FlySweep, ResultsBeyondAnEarlierStopAreWithdrawn) {
  const std::string rule = R"("axes": [], "repeats": {"most": 20, "half_width": 0.15})";
  const Sweep first = sweep(rule + R"(, "set": {"seed": 1})");
  const Sweep second = sweep(rule + R"(, "set": {"seed": 1000})");
  const fs::path lost = own_folder() / "lost";
  copy_run(lost);
  Json metrics = Json::parse(read_text(lost / "metrics.json"));
  metrics["estimators"]["p"]["outcome"] = "LOST";
  write_text(lost / "metrics.json", metrics.dump());
  write_program("if [ $(($(wc -l < '" + calls().string() + "') % 2)) -eq 1 ]; then cp -r '" +
                lost.string() + "' \"$4\"; exit; fi");
  ASSERT_TRUE(fly(first).ok());
  EXPECT_EQ(flights(), 20U);
  write_program();
  ASSERT_TRUE(fly(second).ok());
  EXPECT_EQ(flights(), 29U);
  const auto nine = SweepResults::read(folder());
  ASSERT_TRUE(nine.ok()) << nine.error().message;
  ASSERT_EQ(nine->newest().size(), 9U);
  for (const SweepResult* result : nine->newest()) EXPECT_GE(result->seed, 1000U);
  EXPECT_EQ(nine->unreadable_lines(), 0);
  const std::string written = read_text(folder() / "results.jsonl");
  ASSERT_TRUE(fly(second).ok());
  EXPECT_EQ(read_text(folder() / "results.jsonl"), written) << "nothing more is withdrawn";

  ASSERT_TRUE(fly(first).ok());
  EXPECT_EQ(flights(), 29U) << "results that were withdrawn are not lost";
  EXPECT_EQ(SweepResults::read(folder())->newest().size(), 20U);
}

TEST_F(FlySweep, AnErrorOfLaterRepeatsIsNamedBeforeTheFirstFlight) {
  write_program();
  write_text(own_folder() / "world.json", "{}");
  const auto flown = fly(
      sweep(R"("set": {"world": {"manifest": ")" + (own_folder() / "world.json").string() + R"("}},
         "axes": [{"path": "flight.course.airspeed_m_s", "values": [10, 15]}],
         "repeats": {"most": 2, "vary_world": true})"));
  ASSERT_FALSE(flown.ok());
  EXPECT_THAT(flown.error().message,
              HasSubstr("repeats.vary_world = true: must be false with a world of files (in 2 "
                        "cells; the first is flight.course.airspeed_m_s = 10)"));
  EXPECT_EQ(flights(), 0U);
}

}  // namespace
}  // namespace overfly::server::experiments
