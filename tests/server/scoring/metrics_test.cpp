// Metrics of records made by hand.
#include "server/scoring/metrics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/time.hpp"

namespace overfly::server {
namespace {

using evaluation::AlignmentMode;

constexpr int kFrames = 201;
constexpr std::int64_t kFrameNs = kNsPerS / 10;

/// 20 s at 25 m/s with waves of the attitude: 10 s to the north, then 10 s to the east.
CameraRecords flown_with(const Pose& T_body_camera) {
  CameraRecords camera;
  camera.T_body_camera = T_body_camera;
  for (int i = 0; i < kFrames; ++i) {
    const double t_s = 0.1 * i;
    FrameRow row;
    row.frame = i;
    row.t_ns = i * kFrameNs;
    row.T_world_body.rotation = R_world_body_from(
        {0.3 * std::sin(0.5 * t_s), 0.1 * std::cos(0.4 * t_s), t_s < 10.0 ? 0.0 : 0.5 * kPi});
    row.T_world_body.translation = {
        25.0 * std::max(t_s - 10.0, 0.0), 25.0 * std::min(t_s, 10.0), 300.0};
    row.T_world_camera = row.T_world_body * T_body_camera;
    camera.frames.push_back(row);
  }
  return camera;
}

TEST(Metrics, HaveTheFlownPathAndItsDuration) {
  RunRecords records;
  records.cameras = {flown_with({})};
  const RunMetrics metrics = metrics_from(records);
  EXPECT_NEAR(metrics.flight.path_length_m, 500.0, 1e-6);
  EXPECT_DOUBLE_EQ(metrics.flight.duration_s, 20.0);
}

/// An error of the roll is one of the body's roll whatever the direction in which the camera looks.
TEST(Metrics, ComputeAnglesOfTheBodyThroughTheMount) {
  // Forward, then 40 deg down.
  const Eigen::Quaterniond R_body_forward(
      (Eigen::Matrix3d() << 0, 0, 1, 1, 0, 0, 0, 1, 0).finished());
  const Pose T_body_camera{
      Eigen::AngleAxisd(rad_from_deg(-40.0), Eigen::Vector3d::UnitY()) * R_body_forward,
      {0.4, 0.0, 0.1}};
  RunRecords records;
  records.cameras = {flown_with(T_body_camera)};
  const Pose rolled{
      Eigen::Quaterniond(Eigen::AngleAxisd(rad_from_deg(3.0), Eigen::Vector3d::UnitX())), {}};
  EstimatorRecords& estimator = records.estimators.emplace_back();
  estimator.name = "e";
  for (const FrameRow& row : records.main_camera().frames) {
    EstimateRecord record;
    record.sample.frame = row.frame;
    record.sample.t_ns = row.t_ns;
    record.sample.state = TrackingState::kTracking;
    record.sample.T_vo_camera = row.T_world_body * rolled * T_body_camera;
    estimator.records.push_back(record);
  }
  const RunMetrics metrics = metrics_from(records);
  const auto& none = metrics.estimators.at("e").score.alignments.at(AlignmentMode::kNone);
  ASSERT_TRUE(none.rotation_euler_norm_deg.has_value());
  EXPECT_NEAR(none.rotation_euler_norm_deg->rmse, 3.0, 1e-6);
  EXPECT_NEAR(none.rotation_deg->rmse, 3.0, 1e-6);
}

/// The clock of the camera is wrong by 40 ms: outcomes have the times of the flight.
TEST(Metrics, OutcomesHaveTheTimesOfTheFlightNotOfTheStamps) {
  RunRecords records;
  EstimatorRecords estimator;
  for (int k = 0; k < 20; ++k) {
    FrameRow frame;
    frame.frame = k;
    frame.t_ns = k * kNsPerS / 10;
    frame.T_world_camera.translation.x() = 2.5 * k;
    records.cameras.front().frames.push_back(frame);
    EstimateRecord record;
    record.sample.frame = k;
    record.sample.t_ns = frame.t_ns - 40'000'000;
    record.sample.state = TrackingState::kTracking;
    record.sample.T_vo_camera = frame.T_world_camera;
    estimator.records.push_back(record);
  }
  estimator.records.back().crash = "it ended";
  records.estimators.push_back(estimator);
  const evaluation::Score score = metrics_from(records).estimators.begin()->second.score;
  EXPECT_EQ(score.outcome, evaluation::Outcome::kCrashed);
  EXPECT_DOUBLE_EQ(score.outcome_time_s.value(), 1.9);
  EXPECT_DOUBLE_EQ(score.outcome_distance_m.value(), 2.5 * 19);
  EXPECT_EQ(score.initialised_at_s, 0.0);
}

}  // namespace
}  // namespace overfly::server
