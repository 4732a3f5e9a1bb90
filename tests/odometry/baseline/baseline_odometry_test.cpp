#include "odometry/baseline/baseline_odometry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/time.hpp"
#include "evaluation/evaluation.hpp"
#include "tests/odometry/synthetic_flight.hpp"
#include "tests/odometry/test_frame.hpp"

namespace overfly::odometry::baseline {
namespace {

using ::testing::HasSubstr;

PinholeCamera small_camera() { return {320, 240, 175.0, 175.0, 159.5, 119.5}; }

Image blank() { return {320, 240, 1}; }

VoEstimate tracked(VoPort& port, const VoFrame& frame) {
  Result<VoEstimate> estimate = port.track(frame);
  EXPECT_TRUE(estimate) << (estimate ? "" : estimate.error().message);
  return std::move(*estimate);
}

TEST(BaselineHold, ReportsTheFirstPose) {
  const auto port = create_hold();
  for (std::size_t k = 0; k < 3; ++k) {
    const VoEstimate estimate = tracked(*port, testing::test_frame(k, small_camera(), blank()));
    EXPECT_EQ(estimate.sample.state, TrackingState::kTracking);
    EXPECT_EQ(estimate.sample.T_vo_camera.translation, Eigen::Vector3d::Zero());
  }
}

/// Level flight over level ground is what the homography baseline assumes.
TEST(BaselineHomography, FollowsLevelFlightOverLevelGround) {
  testing::SyntheticFlightOptions options;
  options.height_m = 100.0;
  options.duration_s = 6.0;
  options.straight_s = 6.0;
  options.rate_hz = 15.0;
  const std::vector<Pose> flight = testing::fly_s_turns(options);
  const auto ground = testing::SyntheticGround::procedural(3, 1024, 0.5, 0.0);
  const auto port = create_homography({});
  const CameraModel camera(small_camera());
  Pose last;
  for (std::size_t k = 0; k < flight.size(); ++k) {
    const VoFrame frame =
        testing::test_frame(k, small_camera(), ground.render(camera, flight[k], 1.0, k));
    const VoEstimate estimate = tracked(*port, frame);
    ASSERT_EQ(estimate.sample.state, TrackingState::kTracking) << k;
    ASSERT_TRUE(estimate.sample.scene_depth);
    last = estimate.sample.T_vo_camera;
  }
  const Pose true_motion = flight.front().inverse() * flight.back();
  // One unit is the height.
  EXPECT_NEAR((last.translation * 100.0 - true_motion.translation).norm(),
              0.0,
              0.02 * true_motion.translation.norm());
  EXPECT_LT(rotation_angle_rad(last.rotation, true_motion.rotation), 0.02);
}

TEST(BaselineHomography, FollowsTurnsForAWhile) {
  testing::SyntheticFlightOptions options;
  options.height_m = 100.0;
  options.duration_s = 8.0;
  options.straight_s = 2.0;
  options.rate_hz = 31.0;
  options.bank_max_rad = 0.4;
  const std::vector<Pose> flight = testing::fly_s_turns(options);
  const auto ground = testing::SyntheticGround::procedural(4, 1024, 0.5, 0.0);
  const auto port = create_homography({});
  const CameraModel camera(small_camera());
  Pose last;
  int lost = 0;
  for (std::size_t k = 0; k < flight.size(); ++k) {
    const VoEstimate estimate = tracked(
        *port, testing::test_frame(k, small_camera(), ground.render(camera, flight[k], 1.0, k)));
    lost += estimate.sample.state == TrackingState::kTracking ? 0 : 1;
    last = estimate.sample.T_vo_camera;
  }
  const Pose true_motion = flight.front().inverse() * flight.back();
  EXPECT_EQ(lost, 0);
  EXPECT_LT((last.translation * 100.0 - true_motion.translation).norm(),
            0.1 * 25.0 * options.duration_s);
  EXPECT_LT(rotation_angle_rad(last.rotation, true_motion.rotation), 0.15);
}

TEST(BaselineHomography, IsLostOverNothingAndGoesOnAfterIt) {
  testing::SyntheticFlightOptions options;
  options.height_m = 100.0;
  options.duration_s = 1.0;
  const std::vector<Pose> flight = testing::fly_s_turns(options);
  const auto ground = testing::SyntheticGround::procedural(3, 1024, 0.5, 0.0);
  const auto port = create_homography({});
  const CameraModel camera(small_camera());
  EXPECT_EQ(tracked(*port, testing::test_frame(0, small_camera(), blank())).sample.state,
            TrackingState::kInitialising);
  const auto state_of = [&](std::size_t k, bool dark) {
    Image image = dark ? blank() : ground.render(camera, flight[k], 1.0, k);
    return tracked(*port, testing::test_frame(k, small_camera(), std::move(image))).sample.state;
  };
  state_of(1, false);
  for (std::size_t k = 2; k < 6; ++k) EXPECT_EQ(state_of(k, false), TrackingState::kTracking);
  for (std::size_t k = 6; k < 9; ++k) EXPECT_EQ(state_of(k, true), TrackingState::kLost);
  state_of(9, false);
  EXPECT_EQ(state_of(10, false), TrackingState::kTracking);
}

TEST(BaselineHomography, RefusesUnknownAndImpossibleParameters) {
  EXPECT_THAT(homography_parameters_from({{"corners", 3}}).error().message,
              HasSubstr("parameters.corners"));
  EXPECT_THAT(homography_parameters_from({{"features", 3}}).error().message,
              HasSubstr("[20, 5000]"));
  EXPECT_TRUE(homography_parameters_from({{"reference_px", 30}}));
}

/// A coordinated flight with ideal sensors: straight, then a level turn to the right.
struct SensedTurn {
  static constexpr double kSpeed = 20.0;
  static constexpr double kBank = 0.5;
  static constexpr double kTurnRate = 9.80665 * 0.546302489843790 / kSpeed;  // g tan(bank) / v
  static constexpr double kStraight_s = 2.0;

  static double turned_rad(double t_s) { return kTurnRate * std::max(0.0, t_s - kStraight_s); }

  /// Samples of (from, to]; the bank begins at once.
  static SensorSamples between(double from_s, double to_s) {
    SensorSamples samples;
    for (int k = static_cast<int>(from_s * 200.0) + 1; k <= static_cast<int>(to_s * 200.0 + 1e-9);
         ++k) {
      const double t_s = k / 200.0;
      const std::int64_t t_ns = ns_from_s(t_s);
      const bool turning = t_s > kStraight_s;
      // The roll into the turn is one large angular rate over one sample.
      const bool rolls = turning && (k - 1) / 200.0 <= kStraight_s;
      const double bank = turning ? kBank : 0.0;
      ImuSample imu{t_ns, {0, 0, 0}, {0, 0, 0}, 5'000'000};
      if (turning) {
        imu.angular_rate_rad_s = {0.0, kTurnRate * std::sin(bank), kTurnRate * std::cos(bank)};
      }
      if (rolls) imu.angular_rate_rad_s.x() = kBank * 200.0;
      imu.acceleration_m_s2 = {0.0, 0.0, -9.80665 / std::cos(bank)};
      samples.imu.push_back(imu);
      if (k % 10 != 0) continue;
      samples.airspeed.push_back({t_ns, 0.5 * 1.225 * kSpeed * kSpeed, kSpeed});
      // Field of 20 uT to the north and 45 uT down, nose to the north at first.
      const double yaw = turned_rad(t_s);
      const Eigen::Vector3d field_ned(20.0, 0.0, 45.0);
      const Eigen::Quaterniond R_ned_body = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                                            Eigen::AngleAxisd(bank, Eigen::Vector3d::UnitX());
      samples.magnetometer.push_back({t_ns, R_ned_body.conjugate() * field_ned});
    }
    return samples;
  }
};

TEST(BaselineDeadReckoning, FollowsACoordinatedTurnWithIdealSensors) {
  const auto port = create_dead_reckoning({R_body_camera_nadir(), Eigen::Vector3d::Zero()});
  double before_s = 0.0;
  Pose first;
  Pose last;
  bool started = false;
  for (std::size_t k = 0; k < 31 * 12; ++k) {
    VoFrame frame = testing::test_frame(k, small_camera(), blank());
    const double t_s = s_from_ns(frame.t_ns);
    frame.sensors = SensedTurn::between(before_s, t_s);
    before_s = t_s;
    const VoEstimate estimate = tracked(*port, frame);
    if (estimate.sample.state != TrackingState::kTracking) continue;
    if (!started) first = estimate.sample.T_vo_camera;
    started = true;
    last = estimate.sample.T_vo_camera;
  }
  ASSERT_TRUE(started);
  const double t_s = before_s - SensedTurn::kStraight_s;
  const double radius = SensedTurn::kSpeed / SensedTurn::kTurnRate;
  const double angle = SensedTurn::kTurnRate * t_s;
  // Level frame: x to the nose at the start, y to the left.
  const Eigen::Vector3d expected(
      SensedTurn::kSpeed * SensedTurn::kStraight_s + radius * std::sin(angle),
      -radius * (1.0 - std::cos(angle)),
      0.0);
  // The first pose is some frames after the start; the airspeed starts without a mean.
  EXPECT_LT((last.translation - first.translation - expected).norm(), 4.0);
  const Eigen::Vector3d nose =
      last.rotation * R_body_camera_nadir().conjugate() * Eigen::Vector3d::UnitX();
  EXPECT_NEAR(std::atan2(nose.y(), nose.x()), wrap_pi(-angle), 0.03);
}

TEST(BaselineDeadReckoning, FollowsTurnsBetweenFramesThatAreFarApart) {
  const auto port = create_dead_reckoning({R_body_camera_nadir(), Eigen::Vector3d::Zero()});
  constexpr double kStep_s = 2.0;
  std::vector<Eigen::Vector3d> places;
  for (std::size_t k = 0; k <= 6; ++k) {
    VoFrame frame = testing::test_frame(k, small_camera(), blank());
    const double t_s = kStep_s * static_cast<double>(k);
    frame.t_ns = ns_from_s(t_s);
    if (k > 0) frame.sensors = SensedTurn::between(t_s - kStep_s, t_s);
    const VoEstimate estimate = tracked(*port, frame);
    if (k == 0) continue;  // without samples
    ASSERT_EQ(estimate.sample.state, TrackingState::kTracking);
    places.push_back(estimate.sample.T_vo_camera.translation);
  }
  // From the beginning of the turn, at 2 s, to 12 s.
  const double radius = SensedTurn::kSpeed / SensedTurn::kTurnRate;
  const double angle = SensedTurn::turned_rad(12.0);
  const Eigen::Vector3d expected(radius * std::sin(angle), -radius * (1.0 - std::cos(angle)), 0.0);
  // Steps of a second with the heading at their end: half a step's turn in direction.
  const double tolerance = 0.5 * SensedTurn::kTurnRate * expected.norm() + 5.0;
  EXPECT_LT((places.back() - places.front() - expected).norm(), tolerance);
}

/// Gyroscopes that say nothing, and a compass every two seconds.
TEST(BaselineDeadReckoning, TakesTheHeadingOfASlowCompass) {
  const auto port = create_dead_reckoning({R_body_camera_nadir(), Eigen::Vector3d::Zero()});
  constexpr double kYaw = 0.5;
  Pose last;
  for (std::size_t k = 0; k < 31 * 16; ++k) {
    VoFrame frame = testing::test_frame(k, small_camera(), blank());
    frame.sensors.imu.push_back({frame.t_ns, {0, 0, -9.80665}, {0, 0, 0}, 5'000'000});
    frame.sensors.airspeed.push_back({frame.t_ns, 245.0, 20.0});
    if (k % 62 == 0) {
      const double yaw = k == 0 ? 0.0 : kYaw;
      frame.sensors.magnetometer.push_back(
          {frame.t_ns, {20.0 * std::cos(yaw), -20.0 * std::sin(yaw), 45.0}});
    }
    last = tracked(*port, frame).sample.T_vo_camera;
  }
  const Eigen::Vector3d nose =
      last.rotation * R_body_camera_nadir().conjugate() * Eigen::Vector3d::UnitX();
  EXPECT_NEAR(std::atan2(nose.y(), nose.x()), -kYaw, 0.02);
}

TEST(BaselineDeadReckoning, SaysWhichSamplesAreMissing) {
  const auto port = create_dead_reckoning({});
  for (std::size_t k = 0; k < 110; ++k) {
    const VoEstimate estimate = tracked(*port, testing::test_frame(k, small_camera(), blank()));
    EXPECT_EQ(estimate.sample.state, TrackingState::kInitialising);
  }
  const std::vector<std::string> lines = port->take_log();
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_THAT(lines[0], HasSubstr("no samples of airspeed"));
}

}  // namespace
}  // namespace overfly::odometry::baseline
