#include "evaluation/long_steps.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/evaluation/flights.hpp"

namespace overfly::evaluation {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Trajectory at_times(const std::vector<double>& times_s) {
  Trajectory truth;
  for (const double t_s : times_s) {
    const auto t_ns = static_cast<std::int64_t>(t_s * 1e9);
    EXPECT_TRUE(truth.append({t_ns, {Eigen::Quaterniond::Identity(), {t_s, 0, 0}}}).ok());
  }
  return truth;
}

/// 30 s of a wavy path at 10 Hz, without the poses between two times.
Trajectory with_hole(double begin_s, double end_s) {
  Trajectory truth;
  const Trajectory whole = wavy_truth(300);
  for (const StampedPose& stamped : whole.poses()) {
    const double t_s = s_from_ns(stamped.t_ns);
    if (t_s > begin_s && t_s < end_s) continue;
    EXPECT_TRUE(truth.append(stamped).ok());
  }
  return truth;
}

TEST(LongSteps, AreLongerThanASecondAndTenMedianSteps) {
  const LongSteps dense = long_steps(at_times({0.0, 0.1, 0.2, 1.2, 1.3, 2.5, 2.6}));
  EXPECT_EQ(dense.limit_ns, kNsPerS);
  EXPECT_THAT(dense.ending, ElementsAre(5U));
  EXPECT_NEAR(s_from_ns(dense.longest_ns), 1.2, 1e-8);
  EXPECT_EQ(words_for(dense), "its steps of more than 1.000 s are gaps (1, the longest 1.200 s)");
  // Poses every 2 s are a slow truth, not one with gaps.
  const LongSteps slow = long_steps(at_times({0, 2, 4, 6, 20, 22, 43}));
  EXPECT_EQ(slow.limit_ns, 20 * kNsPerS);
  EXPECT_THAT(slow.ending, ElementsAre(6U));
  EXPECT_THAT(long_steps(at_times({5})).ending, IsEmpty());
  EXPECT_THAT(long_steps({}).ending, IsEmpty());
}

TEST(LongSteps, LeaveOutPausesOfATruthThatStandsStill) {
  Trajectory truth;
  const auto add = [&](double t_s, double x_m) {
    const auto t_ns = static_cast<std::int64_t>(t_s * 1e9);
    EXPECT_TRUE(truth.append({t_ns, {Eigen::Quaterniond::Identity(), {x_m, 0, 0}}}).ok());
  };
  for (int i = 0; i <= 10; ++i) add(0.1 * i, i);
  add(6.0, 10.004);
  add(11.0, 10.1);
  EXPECT_THAT(long_steps(truth).ending, ElementsAre(12U));
}

TEST(LongSteps, LeaveOutGapsThatAreKnown) {
  Trajectory truth = with_hole(10.0, 15.0);
  const LongSteps steps = long_steps(truth);
  ASSERT_THAT(steps.ending, ElementsAre(101U));
  truth = with_gaps_in(steps, std::move(truth));
  EXPECT_THAT(long_steps(truth).ending, IsEmpty());
}

TEST(LongSteps, FramesInThemHaveNoTruth) {
  const EstimateTrack estimate = seen_from(wavy_truth(300), some_similarity());
  const Trajectory truth = with_hole(10.0, 15.0);
  const auto sim3_of = [&](const Trajectory& used) {
    return score(used, estimate, {}).alignments.at(AlignmentMode::kSim3);
  };
  EXPECT_GT(sim3_of(truth).position_m.rmse, 1.0) << "the turn is cut off";
  const AlignmentScore split = sim3_of(with_gaps_in(long_steps(truth), truth));
  EXPECT_LT(split.position_m.rmse, 1e-6);
  EXPECT_THAT(split.notes, ElementsAre("49 tracked frames have no truth"));
}

}  // namespace
}  // namespace overfly::evaluation
