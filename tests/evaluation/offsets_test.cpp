// Offsets of clocks and mounts are found where there are any, and only there.
#include "evaluation/offsets.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/time.hpp"

namespace overfly::evaluation {
namespace {

/// A flight of 60 s at 25 m/s with turns of several periods, hills, and an attitude that banks.
Pose flown_pose(double t_s) {
  const double yaw_rad = 0.8 * std::sin(0.31 * t_s) + 0.4 * std::sin(0.83 * t_s + 1.0);
  const RollPitchYaw attitude{0.4 * std::cos(0.31 * t_s), 0.05 * std::sin(0.5 * t_s), yaw_rad};
  return {R_world_body_from(attitude) * R_body_camera_nadir(),
          {25.0 * t_s + 8.0 * std::sin(0.5 * t_s),
           60.0 * std::sin(0.31 * t_s) + 15.0 * std::sin(0.83 * t_s),
           100.0 + 12.0 * std::sin(0.23 * t_s)}};
}

Trajectory flown_truth() {
  Trajectory truth;
  for (int i = 0; i <= 6000; ++i) {
    EXPECT_TRUE(truth.append({i * 10'000'000LL, flown_pose(0.01 * i)}).ok());
  }
  return truth;
}

struct Made {
  double clock_s = 0.0;  ///< added to an estimate's stamp it gives the true time
  Eigen::Quaterniond R_estimated_true = Eigen::Quaterniond::Identity();
  double position_noise_m = 0.3;
  double rotation_noise_deg = 0.5;
  double drift_m = 0.0;  ///< of the slow error at the end
};

/// An estimate at 20 Hz in a frame of its own with scale 0.2.
EstimateTrack made(const Made& from) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const Eigen::Quaterniond R_vo_world(
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()));
  EstimateTrack track;
  for (int i = 10; i < 1190; ++i) {
    const double t_s = 0.05 * i;
    const Pose pose = flown_pose(t_s);
    EstimateSample sample;
    sample.frame = i;
    sample.t_ns = ns_from_s(t_s - from.clock_s);
    sample.state = TrackingState::kTracking;
    const Eigen::Vector3d noise(normal(random), normal(random), normal(random));
    const double slow = from.drift_m * (t_s / 60.0) * (t_s / 60.0);
    const Eigen::Vector3d drift(slow, slow * std::sin(0.1 * t_s), 0.5 * slow);
    sample.T_vo_camera.translation =
        R_vo_world * (0.2 * (pose.translation + from.position_noise_m * noise + drift));
    const Eigen::Vector3d turn = rad_from_deg(from.rotation_noise_deg) *
                                 Eigen::Vector3d(normal(random), normal(random), normal(random));
    sample.T_vo_camera.rotation =
        R_vo_world * pose.rotation *
        Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized())) *
        from.R_estimated_true.conjugate();
    track.samples.push_back(sample);
  }
  return track;
}

TEST(Offsets, FindsTheOffsetOfAClock) {
  for (const double clock_s : {0.12, -0.7, 1.43}) {
    const Offsets found = find_offsets(flown_truth(), made({.clock_s = clock_s}));
    ASSERT_TRUE(found.clock.has_value()) << clock_s;
    // 0.3 m at 25 m/s are 12 ms a pose; of 1100 poses about 0.4 ms.
    EXPECT_NEAR(s_from_ns(found.clock->offset_ns), clock_s, 0.002);
    EXPECT_NEAR(found.clock->position_rmse_after_m, 0.3 * std::sqrt(3.0), 0.03);
    EXPECT_GT(found.clock->position_rmse_before_m, found.clock->position_rmse_after_m);
    EXPECT_GE(found.clock->explained, kLeastExplained);
    EXPECT_FALSE(found.mount.has_value());
  }
}

/// Without an offset a third of the poses lie in gaps of the truth, so that there is no error which
/// the true offset could be compared with.
TEST(Offsets, ReportsNoClockWithoutAnErrorToExplain) {
  const auto in_second_ns = [](std::int64_t t_ns) { return t_ns % kNsPerS; };
  Trajectory truth;
  const Trajectory whole = flown_truth();
  for (const StampedPose& stamped : whole.poses()) {
    const std::int64_t ns = in_second_ns(stamped.t_ns);
    if (ns > 400'000'000 && ns < 600'000'000) {
      truth.append_gap();
    } else {
      ASSERT_TRUE(truth.append(stamped).ok());
    }
  }
  EstimateTrack track = made({.clock_s = 0.5});
  std::erase_if(track.samples, [&](const EstimateSample& sample) {
    const std::int64_t ns = in_second_ns(sample.t_ns);
    return ns < 290'000'000 || ns > 710'000'000;
  });
  EXPECT_TRUE(find_offsets(flown_truth(), track).clock.has_value());
  EXPECT_FALSE(find_offsets(truth, track).clock.has_value());
}

TEST(Offsets, FindsTheRotationOfAMount) {
  const Eigen::Quaterniond R_estimated_true(
      Eigen::AngleAxisd(rad_from_deg(7.0), Eigen::Vector3d(1, -2, 0.5).normalized()));
  const Offsets found =
      find_offsets(flown_truth(), made({.clock_s = 0.3, .R_estimated_true = R_estimated_true}));
  ASSERT_TRUE(found.mount.has_value());
  // 0.5 deg a pose over 1100 poses, and the rotation of the alignment.
  EXPECT_LT(deg_from_rad(rotation_angle_rad(found.mount->R_estimated_true, R_estimated_true)), 0.1);
  EXPECT_NEAR(found.mount->rotation_rmse_before_deg, 7.0, 0.3);
  EXPECT_NEAR(found.mount->rotation_rmse_after_deg, 0.5 * std::sqrt(3.0), 0.05);
  EXPECT_TRUE(found.clock.has_value());
}

TEST(Offsets, FindsAWrongDefinitionOfTheAxes) {
  const Offsets found =
      find_offsets(flown_truth(), made({.R_estimated_true = R_body_camera_nadir()}));
  ASSERT_TRUE(found.mount.has_value());
  EXPECT_LT(deg_from_rad(rotation_angle_rad(found.mount->R_estimated_true, R_body_camera_nadir())),
            0.1);
}

TEST(Offsets, ReportsNoneWhereThereIsNone) {
  for (const double drift_m : {0.0, 5.0, 30.0}) {
    const Offsets found = find_offsets(flown_truth(), made({.drift_m = drift_m}));
    EXPECT_FALSE(found.clock.has_value()) << drift_m;
  }
  EXPECT_FALSE(find_offsets(flown_truth(), made({})).mount.has_value());
  // An offset smaller than the noise explains nothing.
  EXPECT_FALSE(find_offsets(flown_truth(), made({.clock_s = 0.002})).clock.has_value());
  EXPECT_FALSE(find_offsets(flown_truth(), made({.clock_s = 2.5})).clock.has_value());
}

TEST(Offsets, ReportsNoneOfAStraightPath) {
  Trajectory truth;
  EstimateTrack track;
  for (int i = 0; i <= 600; ++i) {
    const Pose pose{R_body_camera_nadir(), {2.5 * i, 0.0, 100.0}};
    ASSERT_TRUE(truth.append({i * 100'000'000LL, pose}).ok());
    EstimateSample sample;
    sample.frame = i;
    sample.t_ns = i * 100'000'000LL - 500'000'000LL;
    sample.state = TrackingState::kTracking;
    sample.T_vo_camera = pose;
    track.samples.push_back(sample);
  }
  const Offsets found = find_offsets(truth, track);
  EXPECT_FALSE(found.clock.has_value());
  EXPECT_FALSE(found.mount.has_value());
}

TEST(Offsets, NeedsSomePosesInsideTheTruth) {
  EXPECT_FALSE(find_offsets(Trajectory(), made({})).clock.has_value());
  Trajectory brief;
  ASSERT_TRUE(brief.append({0, {}}).ok());
  ASSERT_TRUE(brief.append({1'000'000'000, flown_pose(1.0)}).ok());
  EXPECT_FALSE(find_offsets(brief, made({})).clock.has_value());
}

}  // namespace
}  // namespace overfly::evaluation
