#include "evaluation/errors.hpp"

#include <gtest/gtest.h>

#include "tests/evaluation/flights.hpp"

namespace overfly::evaluation {
namespace {

RollPitchYaw degrees(double roll, double pitch, double yaw) {
  return {rad_from_deg(roll), rad_from_deg(pitch), rad_from_deg(yaw)};
}

TEST(Errors, StatisticsOfKnownNumbers) {
  const ErrorStatistics odd = statistics_of({3.0, 1.0, 2.0});
  EXPECT_DOUBLE_EQ(odd.rmse, std::sqrt(14.0 / 3.0));
  EXPECT_DOUBLE_EQ(odd.mean, 2.0);
  EXPECT_DOUBLE_EQ(odd.median, 2.0);
  EXPECT_DOUBLE_EQ(odd.max, 3.0);
  EXPECT_DOUBLE_EQ(statistics_of({4.0, 1.0, 2.0, 9.0}).median, 3.0);
}

/// The norm of the angles' differences exceeds 180 deg, which no rotation angle can: the paper's
/// 198.6 deg must be of this kind.
TEST(Errors, EulerNormExceeds180DegreesWhereTheGeodesicAngleCannot) {
  const Eigen::Quaterniond a = R_world_body_from(degrees(0, 0, 0));
  const Eigen::Quaterniond b = R_world_body_from(degrees(170, 80, -170));
  EXPECT_NEAR(
      deg_from_rad(euler_norm_rad(b, a)), std::sqrt(170.0 * 170 + 80 * 80 + 170 * 170), 1e-6);
  EXPECT_LE(deg_from_rad(rotation_angle_rad(a, b)), 180.0);

  // A constant error through a whole score.
  Trajectory truth;
  Trajectory estimate;
  const Pose T_body_camera{R_body_camera_nadir(), Eigen::Vector3d::Zero()};
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d p(i, 0.1 * i * i, 300.0);
    ASSERT_TRUE(truth.append({i * kFrameNs, Pose{a, p} * T_body_camera}).ok());
    ASSERT_TRUE(estimate.append({i * kFrameNs, Pose{b, p} * T_body_camera}).ok());
  }
  const Score scored = score(truth, seen_from(estimate, {}), {});
  const AlignmentScore& none = scored.alignments.at(AlignmentMode::kNone);
  EXPECT_NEAR(none.rotation_euler_norm_deg->rmse, 253.3772, 1e-3);
  EXPECT_NEAR(none.rotation_deg->rmse, deg_from_rad(rotation_angle_rad(a, b)), 1e-9);
}

/// Each pose's errors are kept, and the statistics are theirs.
TEST(Errors, OfEachPoseAgreeWithTheStatistics) {
  Trajectory truth;
  Trajectory estimate;
  for (int i = 0; i < 50; ++i) {
    const double t = 0.2 * i;
    const Pose T{R_world_body_from(degrees(3.0 * std::sin(t), 2.0, 5.0 * t)),
                 {10.0 * t, t * t, 300.0 + 4.0 * std::sin(t)}};
    ASSERT_TRUE(truth.append({i * kFrameNs, T}).ok());
    const Pose drift{R_world_body_from(degrees(0.1 * t, 0.0, -0.2 * t)), {0.01 * t * t, -t, 0.0}};
    ASSERT_TRUE(estimate.append({i * kFrameNs, T * drift}).ok());
  }
  EstimateTrack track = seen_from(estimate, {});
  track.samples[7].state = TrackingState::kLost;
  const Score scored = score(truth, track, {});
  ASSERT_EQ(scored.matched_t_ns.size(), 49U);
  EXPECT_EQ(scored.matched_t_ns[7], 8 * kFrameNs);
  EXPECT_GE(scored.alignments.size(), 4U);
  for (const auto& [mode, alignment] : scored.alignments) {
    EXPECT_EQ(alignment.matched, 49);
    ASSERT_EQ(alignment.position_errors_m.size(), 49U) << to_string(mode);
    const ErrorStatistics position_m = statistics_of(alignment.position_errors_m);
    EXPECT_EQ(position_m.rmse, alignment.position_m.rmse);
    EXPECT_EQ(position_m.max, alignment.position_m.max);
    ASSERT_FALSE(alignment.degenerate.has_value()) << to_string(mode);
    ASSERT_EQ(alignment.rotation_errors_deg.size(), 49U) << to_string(mode);
    const ErrorStatistics rotation_deg = statistics_of(alignment.rotation_errors_deg);
    EXPECT_EQ(rotation_deg.rmse, alignment.rotation_deg->rmse);
    EXPECT_EQ(rotation_deg.median, alignment.rotation_deg->median);
  }
  const std::vector<double>& none_m = scored.alignments.at(AlignmentMode::kNone).position_errors_m;
  EXPECT_NEAR(none_m[10], std::hypot(0.01 * 2.2 * 2.2, 2.2), 1e-9) << "of frame 11, at 2.2 s";
}

TEST(Errors, OfRotationAreNotKeptOnAStraightPath) {
  Trajectory truth;
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(
        truth.append({i * kFrameNs, {Eigen::Quaterniond::Identity(), {1.0 * i, 0, 0}}}).ok());
  }
  const Score scored = score(truth, seen_from(truth, {}), {});
  const AlignmentScore& se3 = scored.alignments.at(AlignmentMode::kSe3);
  ASSERT_TRUE(se3.degenerate.has_value());
  EXPECT_TRUE(se3.rotation_errors_deg.empty());
  EXPECT_EQ(se3.position_errors_m.size(), 20U);
}

TEST(Errors, EulerDifferencesWrap) {
  EXPECT_NEAR(deg_from_rad(euler_norm_rad(R_world_body_from(degrees(0, 0, 179)),
                                          R_world_body_from(degrees(0, 0, -179)))),
              2.0,
              1e-9);
}

/// Straight east at 1 m a pose; the estimate is 2 % too long and yaws 0.01 deg a pose.
/// Pieces of 100 m begin at poses 0, 10, ... 100 and end 101 poses on (the first beyond 100 m), so
/// the chord's error and the rotation of each are the same and known.
TEST(Errors, RelativeErrorsOfAHandCheckedPath) {
  std::vector<MatchedPose> matches;
  std::vector<Pose> estimate;
  for (int i = 0; i <= 205; ++i) {
    MatchedPose match;
    match.t_ns = i * kFrameNs;
    match.T_world_camera.translation = {1.0 * i, 0.0, 0.0};
    matches.push_back(match);
    Pose pose;
    pose.translation = {1.02 * i, 0.0, 0.0};
    estimate.push_back(pose);
  }
  const auto straight = relative_errors(matches, estimate, {100.0, 200.0, 1000.0});
  ASSERT_EQ(straight.size(), 2U);  // nothing is 1000 m long
  EXPECT_EQ(straight[0].pairs, 11);
  EXPECT_NEAR(straight[0].translation_percent, 2.0 * 101.0 / 100.0, 1e-9);
  EXPECT_NEAR(straight[0].translation_mean_percent, 2.02, 1e-9);
  EXPECT_EQ(straight[1].pairs, 1);
  EXPECT_NEAR(straight[1].translation_percent, 2.0 * 201.0 / 200.0, 1e-9);

  for (std::size_t i = 0; i < estimate.size(); ++i) {
    estimate[i] = {Eigen::Quaterniond(Eigen::AngleAxisd(rad_from_deg(0.01 * static_cast<double>(i)),
                                                        Eigen::Vector3d::UnitZ())),
                   matches[i].T_world_camera.translation};
  }
  const auto turning = relative_errors(matches, estimate, {100.0});
  EXPECT_NEAR(turning[0].rotation_deg_per_100m, 1.01, 1e-9);
  EXPECT_NEAR(turning[0].rotation_mean_deg_per_100m, 1.01, 1e-9);
}

TEST(Errors, RmsAndMeanOfRelativeErrorsDifferWherePiecesDo) {
  // Two pieces of 10 poses of 1 m (11 to be beyond 10 m): without error, and 10 % too long.
  std::vector<MatchedPose> matches;
  std::vector<Pose> estimate;
  for (int i = 0; i <= 21; ++i) {
    MatchedPose match;
    match.T_world_camera.translation = {1.0 * i, 0.0, 0.0};
    matches.push_back(match);
    Pose pose;
    pose.translation = {i <= 11 ? 1.0 * i : 11.0 + 1.1 * (i - 11), 0.0, 0.0};
    estimate.push_back(pose);
  }
  const auto relative = relative_errors(matches, estimate, {10.0});
  ASSERT_EQ(relative.size(), 1U);
  ASSERT_EQ(relative[0].pairs, 2);  // 0-11: no error; 10-21: 1 m over 10 m
  EXPECT_NEAR(relative[0].translation_mean_percent, 5.0, 1e-9);
  EXPECT_NEAR(relative[0].translation_percent, 10.0 / std::sqrt(2.0), 1e-9);
}

/// 12 km in steps of 20 m, too long by a factor that grows: 1 % more every kilometre.
TEST(Errors, OfLongFlightsAreThoseBetweenPositionFixesToo) {
  std::vector<MatchedPose> matches;
  std::vector<Pose> estimate;
  double way_m = 0.0;
  for (int i = 0; i <= 600; ++i) {
    MatchedPose match;
    match.T_world_camera.translation = {20.0 * i, 0.0, 0.0};
    matches.push_back(match);
    if (i > 0) way_m += 20.0 * (1.0 + 1e-5 * 20.0 * (i - 0.5));
    Pose pose;
    pose.translation = {way_m, 0.0, 0.0};
    estimate.push_back(pose);
  }
  const auto relative = relative_errors(matches, estimate, Options().rpe_lengths_m);
  ASSERT_EQ(relative.size(), 11U);
  EXPECT_EQ(relative[10].length_m, 5000.0);
  for (const RelativeError& error : relative) {
    // Starts are spread evenly from 0 to the last one whose piece ends within the flight; a piece
    // is one step longer than its length.
    const double piece_m = error.length_m + 20.0;
    const double last_start_m = 200.0 * (error.pairs - 1);
    const double mean_percent = 1e-3 * (0.5 * last_start_m + 0.5 * piece_m);
    EXPECT_NEAR(error.translation_mean_percent, mean_percent * piece_m / error.length_m, 1e-9)
        << error.length_m;
  }
}

/// Lost at half of a straight flight: with the last pose held, the error grows with the way.
TEST(Errors, HoldsTheLastPoseToTheEndOfTheFlight) {
  Trajectory truth;
  for (int i = 0; i < 201; ++i) {
    ASSERT_TRUE(
        truth.append({i * kFrameNs, {Eigen::Quaterniond::Identity(), {1.0 * i, 0, 0}}}).ok());
  }
  EstimateTrack track = seen_from(truth, {});
  for (std::size_t i = 0; i < track.samples.size(); ++i) {
    if (i < 10) track.samples[i].state = TrackingState::kInitialising;
    if (i > 100) track.samples[i].state = TrackingState::kLost;
  }
  const Score scored = score(truth, track, {});
  const AlignmentScore& none = scored.alignments.at(AlignmentMode::kNone);
  EXPECT_EQ(none.matched, 91);
  EXPECT_EQ(none.position_m.rmse, 0.0);
  // Frames 10-100 without error, 101-200 with 1 ... 100 m: sum k^2 = 100 * 101 * 201 / 6.
  EXPECT_NEAR(none.position_rmse_hold_m, std::sqrt(100.0 * 101.0 * 201.0 / 6.0 / 191.0), 1e-9);
}

TEST(Errors, OfPositionHaveAHorizontalAndAVerticalPart) {
  const Trajectory truth = wavy_truth(50);
  EstimateTrack track = seen_from(truth, {});
  for (EstimateSample& sample : track.samples) {
    sample.T_vo_camera.translation += Eigen::Vector3d(3.0, 4.0, 12.0);
  }
  const AlignmentScore none = score(truth, track, {}).alignments.at(AlignmentMode::kNone);
  EXPECT_NEAR(none.horizontal_rmse_m.value(), 5.0, 1e-9);
  EXPECT_NEAR(none.vertical_rmse_m.value(), 12.0, 1e-9);
  EXPECT_NEAR(none.position_m.rmse, 13.0, 1e-9);
}

}  // namespace
}  // namespace overfly::evaluation
