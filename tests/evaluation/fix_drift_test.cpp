// Drift between position fixes, against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "evaluation/errors.hpp"

namespace overfly::evaluation {
namespace {

/// Straight east, `count` poses at `step_m`.
std::vector<MatchedPose> straight_path(int count, double step_m) {
  std::vector<MatchedPose> matches;
  for (int i = 0; i < count; ++i) {
    MatchedPose match;
    match.T_world_camera.translation = {step_m * i, 0.0, 300.0};
    matches.push_back(match);
  }
  return matches;
}

TEST(FixDrift, OfAConstantScaleErrorIsItsShareOfTheInterval) {
  // Steps of 7 m: no interval ends at a pose.
  const std::vector<MatchedPose> matches = straight_path(1000, 7.0);
  std::vector<Pose> estimate;
  for (const MatchedPose& match : matches) {
    Pose pose = match.T_world_camera;
    pose.translation *= 1.01;
    estimate.push_back(pose);
  }
  const std::vector<FixDrift> drifts = fix_drifts(matches, estimate, {1000.0, 2000.0, 5000.0});
  ASSERT_EQ(drifts.size(), 3U);
  for (const FixDrift& drift : drifts) {
    EXPECT_EQ(drift.unavailable, "");
    EXPECT_NEAR(drift.median_m, 0.01 * drift.interval_m, 1e-9);
    EXPECT_NEAR(drift.worst_m, 0.01 * drift.interval_m, 1e-9);
    EXPECT_NEAR(drift.horizontal_worst_m, 0.01 * drift.interval_m, 1e-9);
  }
  // 6993 m: starts every 70 m that are at least an interval before the end.
  EXPECT_EQ(drifts[0].segments, 86);
  EXPECT_EQ(drifts[0].apart, 6);
  EXPECT_EQ(drifts[1].segments, 72);
  EXPECT_EQ(drifts[1].apart, 3);
  EXPECT_EQ(drifts[2].segments, 29);
  EXPECT_EQ(drifts[2].apart, 1);
}

/// The heading drifts by w per metre. A fix sets it to the truth, so the estimate's path is an arc
/// that begins in the right direction and ends at (sin(w D) / w, (1 - cos(w D)) / w).
TEST(FixDrift, OfAConstantHeadingDriftIsThatOfAnArc) {
  constexpr double kDriftRadM = 2e-5;  // 1.15 deg per kilometre
  const std::vector<MatchedPose> matches = straight_path(2501, 1.0);
  std::vector<Pose> estimate;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const double heading = kDriftRadM * static_cast<double>(i);
    Pose pose;
    pose.rotation = Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ());
    pose.translation = {
        std::sin(heading) / kDriftRadM, (1.0 - std::cos(heading)) / kDriftRadM, 300.0};
    estimate.push_back(pose);
  }
  const std::vector<FixDrift> drifts = fix_drifts(matches, estimate, {1000.0, 2000.0, 5000.0});
  for (int k = 0; k < 2; ++k) {
    const FixDrift& drift = drifts[static_cast<std::size_t>(k)];
    const double turned = kDriftRadM * drift.interval_m;
    const double expected_m = std::hypot(std::sin(turned) / kDriftRadM - drift.interval_m,
                                         (1.0 - std::cos(turned)) / kDriftRadM);
    EXPECT_NEAR(drift.median_m, expected_m, 1e-6);
    EXPECT_NEAR(drift.worst_m, expected_m, 1e-6);
  }
  EXPECT_NEAR(drifts[0].median_m, 10.0, 0.01);  // w D^2 / 2
  EXPECT_NEAR(drifts[1].median_m, 40.0, 0.02);
  EXPECT_EQ(drifts[2].unavailable, "the scored path is 2500 m long");
  EXPECT_EQ(drifts[2].segments, 0);
}

/// A loop of 1.5 km is flown while the estimator is lost.
TEST(FixDrift, CountsThePathThatIsFlownWhileLost) {
  constexpr int kSteps = 600;
  std::vector<StampedPose> truth;
  EstimateTrack estimate;
  for (int i = 0; i < kSteps; ++i) {
    // 10 m a second; between 200 and 350 s once around.
    const double angle = 2.0 * M_PI * std::clamp((i - 200) / 150.0, 0.0, 1.0);
    const double radius_m = 1500.0 / (2.0 * M_PI);
    const double straight_m = 10.0 * (std::min(i, 200) + std::max(i - 350, 0));
    Pose pose;
    pose.translation = {
        straight_m + radius_m * std::sin(angle), radius_m * (1.0 - std::cos(angle)), 300.0};
    truth.push_back({i * std::int64_t{1'000'000'000}, pose});
    EstimateSample sample;
    sample.frame = i;
    sample.t_ns = truth.back().t_ns;
    sample.state = i > 200 && i < 350 ? TrackingState::kLost : TrackingState::kTracking;
    sample.T_vo_camera = pose;
    estimate.samples.push_back(sample);
  }
  const auto matches =
      associate(Trajectory::from_poses(truth).value(), estimate, Options()).value();
  std::vector<Pose> perfect;
  for (const MatchedPose& match : matches) perfect.push_back(match.T_vo_camera);
  const std::vector<FixDrift> drifts = fix_drifts(matches, perfect, {5000.0, 7000.0});
  EXPECT_GT(drifts[0].segments, 0) << "the straight parts alone are 4490 m long";
  EXPECT_EQ(drifts[1].unavailable, "the scored path is 5989 m long");
}

/// A wrong place and attitude that do not change are removed by every fix.
TEST(FixDrift, IsZeroForAConstantOffset) {
  const std::vector<MatchedPose> matches = straight_path(1200, 1.0);
  const Pose off{Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized())),
                 {50.0, -20.0, 4.0}};
  std::vector<Pose> estimate;
  for (const MatchedPose& match : matches) estimate.push_back(off * match.T_world_camera);
  const std::vector<FixDrift> drifts = fix_drifts(matches, estimate, {1000.0});
  EXPECT_EQ(drifts[0].segments, 20);
  EXPECT_NEAR(drifts[0].worst_m, 0.0, 1e-9);
}

/// The height drifts in the second kilometre only.
TEST(FixDrift, WorstAndMedianDifferWhereTheDriftDoes) {
  const std::vector<MatchedPose> matches = straight_path(3001, 1.0);
  std::vector<Pose> estimate;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    Pose pose = matches[i].T_world_camera;
    pose.translation.z() += 0.02 * std::min(1000.0, std::max(0.0, static_cast<double>(i) - 1000.0));
    estimate.push_back(pose);
  }
  const FixDrift drift = fix_drifts(matches, estimate, {1000.0})[0];
  EXPECT_EQ(drift.segments, 200);  // from 0, 10, ... 1990 m
  EXPECT_EQ(drift.apart, 3);
  EXPECT_NEAR(drift.worst_m, 20.0, 1e-9);
  // From s: 0.02 s up to 1 km, then 0.02 (2000 - s); the middle of 0, 0.2, ... 20, ... 0.2.
  EXPECT_NEAR(drift.median_m, 10.0, 0.11);
  EXPECT_NEAR(drift.horizontal_worst_m, 0.0, 1e-12);
}

}  // namespace
}  // namespace overfly::evaluation
