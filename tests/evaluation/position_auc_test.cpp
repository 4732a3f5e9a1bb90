#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "evaluation/errors.hpp"
#include "tests/evaluation/flights.hpp"

namespace overfly::evaluation {
namespace {

constexpr int kFlightFrames = 221;  // 22 s at 10 Hz
constexpr std::size_t kHalfFrames = 110;

Options options_of_flight() {
  Options options;
  for (int i = 0; i < kFlightFrames; ++i) options.flight.push_back({i, i * kFrameNs});
  return options;
}

/// An estimate of wavy_truth() whose position error grows from 0 to `last_m` at the last frame.
EstimateTrack drifting(const Trajectory& truth, double last_m) {
  EstimateTrack track = seen_from(truth, {});
  for (std::size_t i = 0; i < track.samples.size(); ++i) {
    track.samples[i].T_vo_camera.translation.x() +=
        last_m * static_cast<double>(i) / (kFlightFrames - 1);
  }
  return track;
}

double auc_of(const Trajectory& truth, const EstimateTrack& track, AlignmentMode mode) {
  return score(truth, track, options_of_flight()).alignments.at(mode).position_auc.value();
}

TEST(PositionAuc, IsTheIntegralOfTheShareOfFramesOverTheThreshold) {
  const std::vector<double> errors_m{0.0, 0.25, 3.0, 3.0, 7.5, 9.999, 10.0, 40.0};
  constexpr int kAll = 12;  // four have no error
  constexpr int kSteps = 100'000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double threshold_m = 10.0 * (i + 0.5) / kSteps;
    for (const double error_m : errors_m) sum += error_m < threshold_m ? 1.0 : 0.0;
  }
  // Each of the steps of the curve is off by at most one of the thresholds.
  EXPECT_NEAR(area_under_curve(errors_m, kAll, 10.0), sum / kSteps / kAll, 1.0 / kSteps);
}

TEST(PositionAuc, HasTheValueOfTheFormula) {
  EXPECT_DOUBLE_EQ(area_under_curve({0.0, 0.0}, 2, 10.0), 1.0);
  EXPECT_DOUBLE_EQ(area_under_curve({0.0, 0.0}, 8, 10.0), 0.25);
  EXPECT_DOUBLE_EQ(area_under_curve({2.5, 7.5}, 2, 10.0), 0.5);
  EXPECT_DOUBLE_EQ(area_under_curve({2.5, 7.5}, 2, 5.0), 0.25);
  EXPECT_EQ(area_under_curve({10.0, 11.0, 1e300}, 3, 10.0), 0.0);
  EXPECT_EQ(area_under_curve({}, 3, 10.0), 0.0);
}

TEST(PositionAuc, OfAnErrorThatGrowsEvenlyIsThatOfItsTriangle) {
  const Trajectory truth = wavy_truth(kFlightFrames);
  // Errors of 0, 0.1, ..., 22 m: those below 10 m add 1, 0.99, ..., 0.01, whose sum is 50.5.
  EXPECT_NEAR(
      auc_of(truth, drifting(truth, 22.0), AlignmentMode::kNone), 50.5 / kFlightFrames, 1e-12);
  EXPECT_NEAR(auc_of(truth, drifting(truth, 0.0), AlignmentMode::kNone), 1.0, 1e-12);
}

/// These do not depend on the second half.
constexpr AlignmentMode kFromTheStart[] = {AlignmentMode::kNone,
                                           AlignmentMode::kOrigin,
                                           AlignmentMode::kInitScale,
                                           AlignmentMode::kFirstSim3};

/// The error grows, so the part that is left has the smaller root mean square.
TEST(PositionAuc, OfAHalfThatWasDroppedIsNeverBetterThanOfTheWhole) {
  const Trajectory truth = wavy_truth(kFlightFrames);
  for (const double last_m : {0.0, 5.0, 20.0, 200.0}) {
    const EstimateTrack whole = drifting(truth, last_m);
    EstimateTrack lost = whole;
    EstimateTrack ended = whole;
    EstimateTrack new_map = whole;
    EstimateTrack late = whole;
    for (std::size_t i = 0; i < whole.samples.size(); ++i) {
      if (i >= kHalfFrames) lost.samples[i].state = TrackingState::kLost;
      if (i > kHalfFrames) new_map.samples[i].map_id = 1;
      if (i < kHalfFrames) late.samples[i].state = TrackingState::kInitialising;
    }
    ended.samples.resize(kHalfFrames);
    EXPECT_LE(auc_of(truth, late, AlignmentMode::kNone), auc_of(truth, whole, AlignmentMode::kNone))
        << last_m;
    for (const AlignmentMode mode : kFromTheStart) {
      for (const EstimateTrack& half : {lost, ended, new_map}) {
        EXPECT_LE(auc_of(truth, half, mode), auc_of(truth, whole, mode))
            << last_m << " m, " << to_string(mode);
      }
    }
    EXPECT_LE(score(truth, ended, options_of_flight())
                  .alignments.at(AlignmentMode::kNone)
                  .position_m.rmse,
              score(truth, whole, options_of_flight())
                  .alignments.at(AlignmentMode::kNone)
                  .position_m.rmse);
  }
}

TEST(PositionAuc, CountsFramesWithoutAPoseAsErrorsAboveTheLimit) {
  const Trajectory truth = wavy_truth(kFlightFrames);
  EstimateTrack track = seen_from(truth, some_similarity());
  track.samples.resize(150);
  for (std::size_t i = 0; i < 50; ++i) track.samples[i].state = TrackingState::kInitialising;
  EXPECT_NEAR(auc_of(truth, track, AlignmentMode::kSim3), 100.0 / kFlightFrames, 1e-9);
}

TEST(PositionAuc, OfPosesThatAreNotNumbersIsANumber) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_DOUBLE_EQ(area_under_curve({kNan, 5.0, kInfinity, kNan}, 4, 10.0), 0.125);
  const Trajectory truth = wavy_truth(kFlightFrames);
  EstimateTrack track = seen_from(truth, {});
  track.samples[7].T_vo_camera.translation.x() = kNan;
  EXPECT_NEAR(
      auc_of(truth, track, AlignmentMode::kNone), (kFlightFrames - 1.0) / kFlightFrames, 1e-12);
}

TEST(PositionAuc, NeedsTheFramesOfTheFlight) {
  const Trajectory truth = wavy_truth(kFlightFrames);
  const Score file = score(truth, seen_from(truth, {}), {});
  EXPECT_FALSE(file.alignments.at(AlignmentMode::kNone).position_auc.has_value());
  EXPECT_FALSE(file.position_auc_limit_m.has_value());
  Options options = options_of_flight();
  options.auc_limit_m = 40.0;
  const Score flown = score(truth, drifting(truth, 40.0), options);
  EXPECT_EQ(flown.position_auc_limit_m, 40.0);
  EXPECT_EQ(score(truth, {}, options).position_auc_limit_m, 40.0) << "a flight without a pose";
  EXPECT_NEAR(flown.alignments.at(AlignmentMode::kNone).position_auc.value(), 0.5, 1e-12);
}

}  // namespace
}  // namespace overfly::evaluation
