// The summary of a sweep whose flights have outcomes and errors as written here.
#include "server/experiments/sweep_summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/server/experiments/fly_sweep_fixture.hpp"

namespace overfly::server::experiments {
namespace {

class SweepSummary : public FlySweep {
 protected:
  /// A run in which estimator p has this outcome and position error by Sim(3).
  void write_run(const std::string& name, const char* outcome, double rmse_m) const {
    copy_run(own_folder() / name);
    const std::filesystem::path file = own_folder() / name / "metrics.json";
    auto metrics = nlohmann::json::parse(overfly::testing::read_text(file));
    auto& estimator = metrics.at("estimators").at("p");
    estimator["outcome"] = outcome;
    estimator.at("alignments").at("sim3")["position_rmse_m"] = rmse_m;
    overfly::testing::write_text(file, metrics.dump());
  }
};

/// Every second flight is lost. Wilson's interval of 10 in 20 at z = 1.96: (10 + z^2 / 2) / (20 +
/// z^2)
/// -+ z sqrt(5 + z^2 / 4) / (20 + z^2) = 0.5 -+ 0.2007, too wide to stop before the last repeat.
TEST_F(SweepSummary, LostFlightsCountInTheRateAndNotInTheErrors) {
  write_run("run0", "LOST", 100.0);
  write_run("run1", "COMPLETED", 1.0);
  write_run("run2", "LOST", 100.0);
  write_run("run3", "COMPLETED", 4.0);
  write_program("number=$(($(wc -l < '" + calls().string() + "') % 4))\ncp -r '" +
                (own_folder() / "run").string() + "'$number \"$4\"\nexit 0");
  const Sweep alternating = sweep(R"("axes": [], "repeats": {"most": 20, "half_width": 0.15})");
  const auto flown = fly(alternating);
  ASSERT_TRUE(flown.ok()) << flown.error().message;
  EXPECT_EQ(flights(), 20U);
  const auto rows = summary_of(*flown, folder(), evaluation::AlignmentMode::kSim3);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].flights, 20);
  EXPECT_EQ(rows[0].successes, 10);
  EXPECT_EQ(rows[0].failed, 0);
  EXPECT_EQ(rows[0].outcomes, (std::map<std::string, int>{{"COMPLETED", 10}, {"LOST", 10}}));
  EXPECT_NEAR(rows[0].success_interval.low, 0.299, 0.0005);
  EXPECT_NEAR(rows[0].success_interval.high, 0.701, 0.0005);
  ASSERT_TRUE(rows[0].position_rmse_median_m.has_value());
  EXPECT_DOUBLE_EQ(*rows[0].position_rmse_median_m, 2.5);
  EXPECT_THAT(markdown_from(alternating, rows, evaluation::AlignmentMode::kSim3),
              ::testing::HasSubstr("| p | 20 | 50 [30, 70] | 2.500 |"));
}

}  // namespace
}  // namespace overfly::server::experiments
