#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/evaluation/flights.hpp"

namespace overfly::evaluation {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

constexpr int kPoses = 300;  // 30 s at 10 Hz

AlignmentScore first_sim3_of(const Trajectory& truth,
                             const EstimateTrack& track,
                             const Options& options = {}) {
  return score(truth, track, options).alignments.at(AlignmentMode::kFirstSim3);
}

/// From this pose on the estimate is off by 5 m.
EstimateTrack off_from(const Trajectory& truth, std::size_t first) {
  EstimateTrack track = seen_from(truth, some_similarity());
  const Eigen::Vector3d offset = some_similarity().inverse().rotation *
                                 Eigen::Vector3d(0.0, 3.0, 4.0) / some_similarity().scale;
  for (std::size_t i = first; i < track.samples.size(); ++i) {
    track.samples[i].T_vo_camera.translation += offset;
  }
  return track;
}

TEST(FirstSim3, FitsTheFirstTenSecondsAndShowsTheDriftAfterThem) {
  const Trajectory truth = wavy_truth(kPoses);
  const AlignmentScore first = first_sim3_of(truth, off_from(truth, 101));
  EXPECT_NEAR(first.S_world_vo.scale, some_similarity().scale, 1e-6);
  ASSERT_EQ(first.matched, kPoses);
  for (std::size_t i = 0; i < kPoses; ++i) {
    EXPECT_NEAR(first.position_errors_m[i], i <= 100 ? 0.0 : 5.0, 1e-6) << i;
  }
  EXPECT_FALSE(first.degenerate);
  EXPECT_THAT(first.notes, Contains("fitted to the first 101 of 300 poses (10.0 s)"));
}

TEST(FirstSim3, HasTheTimeOfTheOptions) {
  const Trajectory truth = wavy_truth(kPoses);
  Options options;
  options.first_s = 6.0;
  const AlignmentScore first = first_sim3_of(truth, off_from(truth, 61), options);
  EXPECT_NEAR(first.position_errors_m[60], 0.0, 1e-6);
  EXPECT_NEAR(first.position_errors_m[61], 5.0, 1e-6);
  EXPECT_THAT(first.notes, Contains("fitted to the first 61 of 300 poses (6.0 s)"));
}

TEST(FirstSim3, CountsFromTheFirstMatchedPose) {
  const Trajectory truth = wavy_truth(kPoses);
  EstimateTrack track = off_from(truth, 151);
  for (std::size_t i = 0; i < 50; ++i) track.samples[i].state = TrackingState::kInitialising;
  // A second without poses counts as time.
  for (std::size_t i = 70; i < 80; ++i) track.samples[i].state = TrackingState::kLost;
  const AlignmentScore first = first_sim3_of(truth, track);
  EXPECT_THAT(first.notes, Contains("fitted to the first 91 of 240 poses (10.0 s)"));
  EXPECT_NEAR(first.position_errors_m[90], 0.0, 1e-6);
  EXPECT_NEAR(first.position_errors_m[91], 5.0, 1e-6);
}

TEST(FirstSim3, WithoutTimesFitsAHundredPoses) {
  const Trajectory truth = wavy_truth(kPoses);
  Options options;
  options.has_times = false;
  const AlignmentScore first = first_sim3_of(truth, off_from(truth, 100), options);
  EXPECT_NEAR(first.position_errors_m[99], 0.0, 1e-6);
  EXPECT_NEAR(first.position_errors_m[100], 5.0, 1e-6);
  EXPECT_THAT(first.notes, Contains("fitted to the first 100 of 300 poses (times are not known)"));
}

TEST(FirstSim3, OfAShortFlightIsSim3) {
  const Trajectory truth = wavy_truth(80);
  const Score scored = score(truth, off_from(truth, 40), {});
  const AlignmentScore& first = scored.alignments.at(AlignmentMode::kFirstSim3);
  const AlignmentScore& sim3 = scored.alignments.at(AlignmentMode::kSim3);
  EXPECT_EQ(first.position_errors_m, sim3.position_errors_m);
  EXPECT_THAT(first.notes, Contains("fitted to the first 80 of 80 poses (7.9 s)"));
}

/// North for 12 s, then a circle of 500 m, at 25 m/s.
Trajectory leg_and_turn() {
  constexpr double kRadiusM = 500.0;
  Trajectory truth;
  for (int i = 0; i < kPoses; ++i) {
    const double way_m = 2.5 * i;
    const double turn_rad = std::max(0.0, way_m - 300.0) / kRadiusM;
    const Eigen::Vector3d p(kRadiusM * (1.0 - std::cos(turn_rad)),
                            std::min(way_m, 300.0) + kRadiusM * std::sin(turn_rad),
                            300.0);
    const Pose T_world_body{R_world_body_from({0.0, 0.0, turn_rad}), p};
    EXPECT_TRUE(truth
                    .append({i * kFrameNs,
                             T_world_body * Pose{R_body_camera_nadir(), Eigen::Vector3d::Zero()}})
                    .ok());
  }
  return truth;
}

/// The rotation about the first leg moves the poses beside it, so it must not be that of noise.
TEST(FirstSim3, TakesTheRotationAboutAStraightStartFromTheOrientations) {
  const Trajectory truth = leg_and_turn();
  for (const double noise_m : {0.0, 0.5}) {
    EstimateTrack track = seen_from(truth, some_similarity());
    std::mt19937_64 random(5);
    std::normal_distribution<double> noise(0.0, noise_m / some_similarity().scale);
    for (EstimateSample& sample : track.samples) {
      if (noise_m == 0.0) continue;
      sample.T_vo_camera.translation +=
          Eigen::Vector3d(noise(random), noise(random), noise(random));
    }
    const AlignmentScore first = first_sim3_of(truth, track);
    EXPECT_THAT(first.degenerate.value_or(""), HasSubstr("nearly straight")) << noise_m;
    EXPECT_FALSE(first.rotation_deg);
    EXPECT_THAT(first.notes, Contains(HasSubstr("taken from the orientations"))) << noise_m;
    EXPECT_LT(first.position_m.max, noise_m > 0.0 ? 6.0 : 1e-5) << noise_m;
  }
}

TEST(FirstSim3, SaysWhatTheFirstPosesDoNotDetermine) {
  const Trajectory truth = wavy_truth(kPoses);
  EstimateTrack track = seen_from(truth, some_similarity());
  for (std::size_t i = 1; i < 150; ++i) track.samples[i].state = TrackingState::kLost;
  EXPECT_EQ(score(truth, track, {}).unavailable.at(AlignmentMode::kFirstSim3),
            "the first 1 of 151 poses (0.0 s): 1 matched poses: must be at least 2");

  track = seen_from(truth, some_similarity());
  for (std::size_t i = 1; i < 120; ++i) {
    track.samples[i].T_vo_camera.translation = track.samples[0].T_vo_camera.translation;
  }
  EXPECT_THAT(score(truth, track, {}).unavailable.at(AlignmentMode::kFirstSim3),
              HasSubstr("(10.0 s): the estimate does not move"));
}

}  // namespace
}  // namespace overfly::evaluation
