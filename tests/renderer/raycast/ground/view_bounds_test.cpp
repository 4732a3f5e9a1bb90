// The rays of a camera on its grid, and bounds that hold them all during an exposure.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "renderer/raycast/ground/ray_grid.hpp"
#include "renderer/raycast/ground/view_sweep.hpp"
#include "tests/support/support.hpp"

namespace overfly::renderer::raycast {
namespace {

using overfly::testing::larger_error;

PinholeCamera off_centre_pinhole() { return {203, 117, 150.0, 140.0, 90.0, 61.0}; }

std::vector<CameraModel> lenses() {
  return {{off_centre_pinhole(), {DistortionModel::kRadtan, {-0.25, 0.08, 2e-3, -1e-3, 0.0}}},
          {off_centre_pinhole(), {DistortionModel::kEquidistant, {-0.02, 0.01, 0.0, 0.0}}},
          {off_centre_pinhole(), {DistortionModel::kFov, {0.9}}}};
}

TEST(RayGrid, NodesAreTheCamerasRaysBetweenItsPixels) {
  std::vector<CameraModel> cameras = lenses();
  cameras.emplace_back(off_centre_pinhole());
  cameras.emplace_back(PinholeCamera{1, 1, 10.0, 10.0, 0.0, 0.0});
  for (const CameraModel& camera : cameras) {
    ASSERT_TRUE(camera.validate());
    const RayGrid grid(camera);
    const PinholeCamera& size = camera.pinhole();
    EXPECT_EQ(grid.left_px(grid.columns()), size.width_px);
    EXPECT_EQ(grid.top_px(grid.rows()), size.height_px);
    for (int row = 0; row <= grid.rows(); ++row) {
      for (int column = 0; column <= grid.columns(); ++column) {
        const auto ray = camera.ray({grid.left_px(column) - 0.5, grid.top_px(row) - 0.5});
        ASSERT_TRUE(ray.has_value());
        EXPECT_EQ(grid.ray(column, row), ray->head<2>());
      }
    }
  }
}

TEST(RayGrid, InterpolatedRaysMeetTheirPixels) {
  for (const CameraModel& camera : lenses()) {
    const RayGrid grid(camera);
    EXPECT_LT(grid.cell_px(), kCellPx) << "these lenses bend more than one cell may";
    double worst_px = 0.0;
    for (int y = 0; y < camera.pinhole().height_px; ++y) {
      for (int x = 0; x < camera.pinhole().width_px; ++x) {
        const int column = x / grid.cell_px(), row = y / grid.cell_px();
        const double a =
            (x + 0.5 - grid.left_px(column)) / (grid.left_px(column + 1) - grid.left_px(column));
        const double b = (y + 0.5 - grid.top_px(row)) / (grid.top_px(row + 1) - grid.top_px(row));
        const Eigen::Vector2d top =
            (1.0 - a) * grid.ray(column, row) + a * grid.ray(column + 1, row);
        const Eigen::Vector2d bottom =
            (1.0 - a) * grid.ray(column, row + 1) + a * grid.ray(column + 1, row + 1);
        const Eigen::Vector2d ray = (1.0 - b) * top + b * bottom;
        const auto seen = camera.project({ray.x(), ray.y(), 1.0});
        ASSERT_TRUE(seen.has_value());
        worst_px = larger_error(worst_px, (*seen - Eigen::Vector2d(x, y)).norm());
      }
    }
    EXPECT_LE(worst_px, kLensErrorPx) << to_string(camera.distortion().model);
  }
}

TEST(RayGrid, SharpnessIsThatOfStepsAlongTheImagePlane) {
  // A step of d parallel to the image plane, at a distance r of the camera, is f d / z long in the
  // image: f |ray| per d / r, the most at the farthest corner.
  for (const PinholeCamera& camera : {PinholeCamera{320, 240, 200.0, 200.0, 159.5, 119.5},
                                      PinholeCamera{16, 16, 5.0, 5.0, 0.0, 0.0},
                                      off_centre_pinhole()}) {
    double expected = 0.0;
    for (const double x : {-0.5, camera.width_px - 0.5}) {
      for (const double y : {-0.5, camera.height_px - 0.5}) {
        const double per_rad = std::max(camera.fx_px, camera.fy_px) * camera.ray({x, y}).norm();
        expected = std::max(expected, per_rad);
      }
    }
    EXPECT_NEAR(RayGrid(camera).px_per_rad(), expected, 1e-6 * expected);
  }
}

TEST(RayGrid, BelongsToOneCameraOnly) {
  const CameraModel camera = lenses()[0];
  const RayGrid grid(camera);
  EXPECT_TRUE(grid.is_of(CameraModel(camera)));
  const auto other = [&](const auto& change) {
    PinholeCamera pinhole = camera.pinhole();
    Distortion distortion = camera.distortion();
    change(pinhole, distortion);
    return grid.is_of(CameraModel(pinhole, distortion));
  };
  EXPECT_FALSE(other([](PinholeCamera& p, Distortion&) { ++p.width_px; }));
  EXPECT_FALSE(other([](PinholeCamera& p, Distortion&) { ++p.height_px; }));
  EXPECT_FALSE(other([](PinholeCamera& p, Distortion&) { p.fx_px += 1e-9; }));
  EXPECT_FALSE(other([](PinholeCamera& p, Distortion&) { p.fy_px += 1e-9; }));
  EXPECT_FALSE(other([](PinholeCamera& p, Distortion&) { p.cx_px += 1e-9; }));
  EXPECT_FALSE(other([](PinholeCamera& p, Distortion&) { p.cy_px += 1e-9; }));
  EXPECT_FALSE(other([](PinholeCamera&, Distortion& d) { d.k[3] += 1e-9; }));
  EXPECT_FALSE(other([](PinholeCamera&, Distortion& d) { d = {}; }));
}

/// A camera that turns and moves between poses 4 ms apart, by up to a tenth of a radian each.
CameraRequest restless_request(const CameraModel& camera, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  RollPitchYaw attitude{0.3 * unit(random), 0.3 * unit(random), 3.0 * unit(random)};
  Eigen::Vector3d p(0.0, 0.0, 200.0);
  std::vector<StampedPose> poses;
  for (int i = 0; i < 11; ++i) {
    poses.push_back({4'000'000LL * i, {R_world_body_from(attitude) * R_body_camera_nadir(), p}});
    attitude.roll_rad += 0.1 * unit(random);
    attitude.pitch_rad += 0.1 * unit(random);
    attitude.yaw_rad += 0.1 * unit(random);
    p += 0.5 * Eigen::Vector3d(unit(random), unit(random), unit(random));
  }
  CameraRequest request;
  request.camera = camera;
  request.T_world_camera = CameraMotion::from_poses(poses).value();
  request.t_ns = 20'000'000;
  request.exposure_ns = 10'000'000;
  request.readout_ns = 25'000'000;
  return request;
}

TEST(ViewSweep, HoldsEveryRayOfEveryRowDuringTheWholeExposure) {
  std::mt19937 random(3);
  std::vector<CameraModel> cameras = lenses();
  cameras.emplace_back(off_centre_pinhole());
  for (const CameraModel& camera : cameras) {
    const RayGrid grid(camera);
    for (int trial = 0; trial < 20; ++trial) {
      const CameraRequest request = restless_request(camera, random);
      const ViewSweep sweep = sweep_of(request, grid);
      ASSERT_TRUE(sweep.bounded);
      for (int i = 0; i < 300; ++i) {
        // Pixels of the image's edge, where rays may leave the bounds.
        const bool upright = (i & 1) != 0;
        const int x = upright ? (i & 2) / 2 * 202 : static_cast<int>(random() % 203);
        const int y = upright ? static_cast<int>(random() % 117) : (i & 2) / 2 * 116;
        const std::int64_t offset_ns = static_cast<std::int64_t>(random() % 10'000'001) - 5'000'000;
        const Pose pose = request.T_world_camera.at(request.row_time_ns(y) + offset_ns);
        const Eigen::Vector3d ray = pose.rotation * *camera.ray({x, y});
        for (const Eigen::Vector3d& normal : sweep.side_normals) ASSERT_GE(normal.dot(ray), 0.0);
        ASSERT_LE((pose.translation - sweep.position).norm(), sweep.slack_m + 1e-9);
      }
    }
  }
}

TEST(ViewSweep, IsLittleWiderThanAStillImage) {
  const PinholeCamera camera = off_centre_pinhole();
  const Pose pose{R_world_body_from({0.4, -0.2, 1.0}) * R_body_camera_nadir(), {1.0, 2.0, 300.0}};
  const ViewSweep sweep = sweep_of(CameraRequest::still(camera, pose, 0, PixelFormat::kGrey8),
                                   RayGrid(CameraModel(camera)));
  EXPECT_EQ(sweep.slack_m, 0.0);
  const auto held = [&](double x, double y) {
    const Eigen::Vector3d ray = pose.rotation * camera.ray({x, y});
    return std::all_of(sweep.side_normals.begin(), sweep.side_normals.end(), [&](const auto& n) {
      return n.dot(ray) >= 0.0;
    });
  };
  EXPECT_TRUE(held(-0.5, -0.5) && held(202.5, 116.5));
  EXPECT_FALSE(held(-0.05 * 203, 58.0) || held(1.05 * 203, 58.0));
  EXPECT_FALSE(held(101.0, -0.05 * 117) || held(101.0, 1.05 * 117));
  for (const Eigen::Vector3d& normal : sweep.side_normals) EXPECT_NEAR(normal.norm(), 1.0, 1e-12);
}

TEST(ViewSweep, HasNoBoundsForACameraThatTurnsPastItsOwnImagePlane) {
  const auto pose = [](double roll_rad) {
    return Pose{R_world_body_from({roll_rad, 0.0, 0.0}) * R_body_camera_nadir(), {0, 0, 300.0}};
  };
  CameraRequest request;
  request.camera = off_centre_pinhole();
  request.T_world_camera =
      CameraMotion::from_poses({{0, pose(-1.0)}, {20, pose(0.0)}, {40, pose(1.0)}}).value();
  request.t_ns = 20;
  request.exposure_ns = 40;
  const ViewSweep sweep = sweep_of(request, RayGrid(request.camera));
  EXPECT_FALSE(sweep.bounded);
  for (const Eigen::Vector3d& normal : sweep.side_normals) EXPECT_EQ(normal.norm(), 0.0);
}

}  // namespace
}  // namespace overfly::renderer::raycast
