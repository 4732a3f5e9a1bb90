// Where pixels look, against closed forms and the renderer's depth.
#include "server/views/images/line_of_sight.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/earth/height_query.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::server {
namespace {

using overfly::testing::ProceduralGround;
using renderer::CameraRequest;
using renderer::PixelFormat;

const PinholeCamera kCamera{640, 480, 500.0, 500.0, 319.5, 239.5};

/// A nadir camera, image top to the north, rolled to the right about its nose.
Pose nadir_pose(double east_m, double north_m, double up_m, double roll_rad = 0.0) {
  Eigen::Matrix3d R_world_camera;
  R_world_camera << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  const Eigen::AngleAxisd roll(roll_rad, Eigen::Vector3d::UnitY());
  return {Eigen::Quaterniond(roll * R_world_camera), {east_m, north_m, up_m}};
}

CameraRequest request_at(const Pose& pose, const CameraModel& model = CameraModel(kCamera)) {
  return CameraRequest::still(model, pose, 0, PixelFormat::kGrey8);
}

TEST(GroundSight, IsExactOnFlatGround) {
  const FlatGround ground(20.0);
  const auto sight =
      ground_sight(request_at(nadir_pose(100.0, -50.0, 320.0)), {519.5, 139.5}, ground);
  ASSERT_TRUE(sight);
  EXPECT_NEAR(sight->depth_m, 300.0, 1e-3);
  EXPECT_NEAR(sight->ground_world_m.x(), 100.0 + 300.0 * 200.0 / 500.0, 1e-3);
  EXPECT_NEAR(sight->ground_world_m.y(), -50.0 + 300.0 * 100.0 / 500.0, 1e-3);
  EXPECT_NEAR(sight->ground_world_m.z(), 20.0, 1e-3);
  EXPECT_NEAR(sight->range_m, 300.0 * std::sqrt(1.0 + 0.16 + 0.04), 1e-3);
}

TEST(GroundSight, HasNoneInTheSky) {
  const FlatGround ground(0.0);
  const Pose level = nadir_pose(0.0, 0.0, 300.0, 2.0);
  EXPECT_FALSE(ground_sight(request_at(level), {319.5, 239.5}, ground));
}

TEST(GroundSight, GoesThroughTheLens) {
  const FlatGround ground(0.0);
  const CameraModel fisheye(kCamera,
                            {DistortionModel::kEquidistant, {-0.01, 0.002, 0.0, 0.0, 0.0}});
  const Eigen::Vector3d point(140.0, 80.0, 0.0);
  const Pose pose = nadir_pose(0.0, 0.0, 250.0, 0.2);
  const auto pixel = fisheye.project(pose.rotation.conjugate() * (point - pose.translation));
  ASSERT_TRUE(pixel);
  const auto sight = ground_sight(request_at(pose, fisheye), *pixel, ground);
  ASSERT_TRUE(sight);
  EXPECT_LT((sight->ground_world_m - point).norm(), 2e-3);
}

TEST(GroundSight, IsThatOfTheRowsOwnTime) {
  const FlatGround ground(0.0);
  // 100 m/s to the east, 20 ms from the first row to the last.
  CameraRequest request = request_at(nadir_pose(0.0, 0.0, 200.0));
  request.T_world_camera = CameraMotion::from_poses({{-20'000'000, nadir_pose(-2.0, 0.0, 200.0)},
                                                     {20'000'000, nadir_pose(2.0, 0.0, 200.0)}})
                               .value();
  request.readout_ns = 20'000'000;
  const auto first = ground_sight(request, {319.5, 0.0}, ground);
  const auto last = ground_sight(request, {319.5, 479.0}, ground);
  ASSERT_TRUE(first && last);
  EXPECT_NEAR(first->ground_world_m.x(), -1.0, 1e-3);
  EXPECT_NEAR(last->ground_world_m.x(), 1.0, 1e-3);
}

TEST(GroundSight, HasTheDepthThatTheRendererDraws) {
  const auto ground = overfly::testing::natural_ground();
  const auto renderer = renderer::create_raycast_renderer(ground);
  const double above_m = ground->ground_up_m(30.0, 40.0);
  const CameraRequest request = request_at(nadir_pose(30.0, 40.0, above_m + 150.0, 0.5));
  const auto depth = renderer->render_depth(request);
  ASSERT_TRUE(depth.ok()) << depth.error().message;
  int compared = 0;
  for (int y = 12; y < 480; y += 57) {
    for (int x = 9; x < 640; x += 61) {
      if (!std::isfinite(depth->at(x, y))) continue;
      const auto sight = ground_sight(request, {x, y}, *ground);
      ASSERT_TRUE(sight) << x << ", " << y;
      EXPECT_NEAR(sight->depth_m, depth->at(x, y), 0.02 + 2e-4 * sight->depth_m) << x << ", " << y;
      ++compared;
    }
  }
  EXPECT_GT(compared, 80);
}

}  // namespace
}  // namespace overfly::server
