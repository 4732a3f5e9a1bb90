#include "server/timeline/live_alignment.hpp"

#include <gtest/gtest.h>

#include "core/time.hpp"
#include "evaluation/evaluation.hpp"

namespace overfly::server {
namespace {

EstimateSample tracked(std::int64_t t_s, double x, std::optional<double> depth, int map_id = 0) {
  EstimateSample sample;
  sample.frame = t_s;
  sample.t_ns = t_s * kNsPerS;
  sample.state = TrackingState::kTracking;
  sample.T_vo_camera.translation.x() = x;
  sample.scene_depth = depth;
  sample.map_id = map_id;
  return sample;
}

Pose at_x(double x) { return {Eigen::Quaterniond::Identity(), {x, 0, 0}}; }

TEST(LiveAlignment, AgreesWithTheEvaluationsInitScale) {
  const Pose T_body_camera{R_body_camera_nadir(), Eigen::Vector3d::Zero()};
  Pose first = at_x(100);
  first.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()));
  LiveAlignment alignment(T_body_camera);
  std::vector<evaluation::MatchedPose> matches;
  for (int i = 0; i < 3; ++i) {
    Pose truth = first;
    truth.translation += first.rotation * Eigen::Vector3d(30.0 * i, 0, 0);
    const EstimateSample sample = tracked(i, 0.1 * i, 1.0);
    matches.push_back({sample.t_ns, truth, sample.T_vo_camera, sample.scene_depth});
    EXPECT_TRUE(alignment.add(sample, truth, 300.0).has_value());
  }
  evaluation::Options options;
  options.init_true_depth_m = 300.0;
  const auto S = evaluation::align(matches, evaluation::AlignmentMode::kInitScale, options);
  ASSERT_TRUE(S.ok()) << S.error().message;
  ASSERT_TRUE(alignment.S_world_vo().has_value());
  EXPECT_NEAR(alignment.S_world_vo()->scale, S->scale, 1e-9);
  EXPECT_LT((alignment.S_world_vo()->translation - S->translation).norm(), 1e-9);
  EXPECT_LT(rotation_angle_rad(alignment.S_world_vo()->rotation, S->rotation), 1e-9);
}

TEST(LiveAlignment, TakesTheScaleFromFiveSecondsOfPathWithoutADepth) {
  LiveAlignment alignment{Pose{}};
  for (int t = 0; t < 5; ++t) {
    EXPECT_FALSE(alignment.add(tracked(t, 0.5 * t, {}), at_x(10.0 * t), 300.0).has_value());
  }
  const auto placed = alignment.add(tracked(5, 2.5, {}), at_x(50.0), 300.0);
  ASSERT_TRUE(placed.has_value());
  EXPECT_NEAR(placed->translation.x(), 50.0, 1e-9);
}

TEST(LiveAlignment, StartsAnewWithANewMap) {
  LiveAlignment alignment{Pose{}};
  EXPECT_NEAR(alignment.add(tracked(0, 0, 1.0), at_x(0), 300.0)->translation.x(), 0.0, 1e-9);
  const auto placed = alignment.add(tracked(9, 4.0, 2.0, 1), at_x(90), 200.0);
  ASSERT_TRUE(placed.has_value());
  EXPECT_NEAR(placed->translation.x(), 90.0, 1e-9);
  EXPECT_NEAR(alignment.S_world_vo()->scale, 100.0, 1e-9);
}

TEST(LiveAlignment, KeepsAMapsAlignmentWhenTheEstimatorReturnsToIt) {
  LiveAlignment alignment{Pose{}};
  ASSERT_TRUE(alignment.add(tracked(0, 0.0, 1.0), at_x(0), 300.0).has_value());
  ASSERT_TRUE(alignment.add(tracked(2, 0.0, 2.0, 1), at_x(60), 300.0).has_value());
  // The first map has drifted by 10 m when the estimator finds back into it.
  const auto placed = alignment.add(tracked(3, 0.1, 2.0), at_x(40), 300.0);
  ASSERT_TRUE(placed.has_value());
  EXPECT_NEAR(placed->translation.x(), 30.0, 1e-9);
  EXPECT_NEAR(alignment.S_world_vo()->scale, 300.0, 1e-9);
}

}  // namespace
}  // namespace overfly::server
