// Points in an image of a rolling shutter, against a search over the times of its rows.
#include "renderer/camera/row_projector.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace overfly::renderer {
namespace {

constexpr std::int64_t kMiddleNs = 500'000'000;

Pose turning_pose(double t_s) {
  return {R_world_body_from({0.2 + 0.8 * t_s, -0.5 * t_s, 1.0 + 0.6 * t_s}) * R_body_camera_nadir(),
          {30.0 * t_s, -10.0 * t_s, 150.0 + 2.0 * t_s}};
}

CameraRequest turning_request() {
  std::vector<StampedPose> poses;
  for (int i = -50; i <= 50; ++i) {
    poses.push_back({kMiddleNs + 1'000'000LL * i, turning_pose(1e-3 * i)});
  }
  CameraRequest request;
  request.camera = PinholeCamera{200, 150, 160.0, 160.0, 99.5, 74.5};
  request.T_world_camera = CameraMotion::from_poses(poses).value();
  request.t_ns = kMiddleNs;
  request.readout_ns = 40'000'000;
  return request;
}

TEST(RowProjector, FindsTheRowWhoseTimeSeesThePoint) {
  const CameraRequest request = turning_request();
  const RowProjector projector(request);
  for (double east_m = -80.0; east_m <= 80.0; east_m += 20.0) {
    for (double north_m = -60.0; north_m <= 60.0; north_m += 20.0) {
      const Eigen::Vector3d p(east_m, north_m, 0.1 * east_m);
      // Bisection for the row at whose time the point is in that row.
      const auto seen_at = [&](double row) {
        const Pose pose = request.T_world_camera.at(request.row_time_ns(row));
        return request.camera.project(pose.inverse() * p).value();
      };
      double low = 0.0, high = 149.0;
      if (seen_at(low).y() < low || seen_at(high).y() > high) continue;
      while (high - low > 1e-9) {
        const double row = 0.5 * (low + high);
        (seen_at(row).y() > row ? low : high) = row;
      }
      const auto projected = projector.project(p);
      ASSERT_TRUE(projected.has_value());
      EXPECT_LT((projected->pixel - seen_at(low)).norm(), 1e-3);
      const Pose pose = request.T_world_camera.at(request.row_time_ns(low));
      EXPECT_NEAR(projected->depth_m, (pose.inverse() * p).z(), 1e-3);
    }
  }
}

TEST(RowProjector, UsesTheBordersPoseBeyondTheImage) {
  const CameraRequest request = turning_request();
  const RowProjector projector(request);
  for (const auto& [pixel_y, row] : {std::pair{-30.0, 0}, std::pair{180.0, 149}}) {
    const Pose& border = projector.T_world_camera(row);
    const Eigen::Vector3d p = border * (120.0 * request.camera.pinhole().ray({90.0, pixel_y}));
    const auto projected = projector.project(p);
    ASSERT_TRUE(projected.has_value());
    EXPECT_LT((projected->pixel - Eigen::Vector2d(90.0, pixel_y)).norm(), 1e-6);
    EXPECT_FALSE(projector.inside(projected->pixel));
  }
}

TEST(RowProjector, KnowsItsRowsAndItsImage) {
  const CameraRequest request = turning_request();
  const RowProjector projector(request);
  const Pose first = request.T_world_camera.at(kMiddleNs - 20'000'000);
  EXPECT_EQ(projector.T_world_camera(0).translation, first.translation);
  EXPECT_FALSE(projector.project({0.0, 0.0, 400.0}).has_value()) << "behind the camera";
  EXPECT_TRUE(projector.inside({0.0, 149.0}) && projector.inside({199.0, 0.0}));
  EXPECT_FALSE(projector.inside({-0.01, 5.0}) || projector.inside({199.01, 5.0}));
  EXPECT_FALSE(projector.inside({5.0, -0.01}) || projector.inside({5.0, 149.01}));
  CameraRequest global = request;
  global.readout_ns = 0;
  const RowProjector still(global);
  EXPECT_EQ(still.T_world_camera(0).translation, still.T_world_camera(149).translation);
  EXPECT_EQ(still.T_world_camera(7).translation, request.T_world_camera.at(kMiddleNs).translation);
}

}  // namespace
}  // namespace overfly::renderer
