// Rays that run along the sides of the ray-caster's squares.
#include <gtest/gtest.h>

#include <cmath>

#include "renderer/renderer.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer {
namespace {

using overfly::testing::ProceduralGround;

TEST(RaycastSides, RaysAlongASquaresSideMeetTheGround) {
  ProceduralGround::Options options;
  options.paint = [](double, double) { return 100.0; };
  // Flat where the camera looks; the hill makes slopes, so that descent is not enough for any ray.
  options.height_m = [](double east_m, double north_m) {
    return std::max(0.0, 30.0 - 0.5 * std::hypot(east_m - 800.0, north_m));
  };
  options.height_range_m = {0.0, 30.0};
  options.curved = false;
  const auto renderer = create_raycast_renderer(std::make_shared<ProceduralGround>(options));
  // An odd size: the middle column's rays have no sideways part but rounding.
  const PinholeCamera camera{65, 49, 40.0, 40.0, 32.0, 24.0};
  for (const double place_m : {0.0, 4.0, -256.0}) {
    for (const double yaw_rad : {0.0, 0.5 * kPi, kPi, 1.5 * kPi, 1e-12, -1e-15}) {
      for (const double pitch_rad : {0.0, 0.6, -0.6}) {
        const Pose pose{R_world_body_from({0.0, pitch_rad, yaw_rad}) * R_body_camera_nadir(),
                        {place_m, place_m, 120.0}};
        const auto depth = renderer->render_depth(camera, pose);
        ASSERT_TRUE(depth.ok()) << depth.error().message;
        const Eigen::Matrix3d R = pose.rotation.toRotationMatrix();
        for (int y = 0; y < camera.height_px; ++y) {
          const Eigen::Vector3d ray =
              R * Eigen::Vector3d(0.0, (y - camera.cy_px) / camera.fy_px, 1.0);
          if (ray.z() > -0.3) continue;
          ASSERT_NEAR(depth->at(32, y), 120.0 / -ray.z(), 1e-2)
              << "row " << y << " from " << place_m << " m, yaw " << yaw_rad << ", pitch "
              << pitch_rad;
        }
      }
    }
  }
}

TEST(RaycastSides, AViewWiderThanItsBoundsHasNoHoles) {
  // Rays up to 88 deg from the axis, for which no planes around the view exist.
  const CameraModel fisheye(PinholeCamera{300, 300, 138.0, 138.0, 149.5, 149.5},
                            {DistortionModel::kEquidistant, {}});
  ASSERT_TRUE(fisheye.validate());
  ProceduralGround::Options options;
  options.paint = [](double, double) { return 100.0; };
  options.curved = false;
  const auto renderer = create_raycast_renderer(std::make_shared<ProceduralGround>(options));
  for (const double yaw_rad : {0.3, 2.0}) {
    const Pose pose{R_world_body_from({0.0, 0.0, yaw_rad}) * R_body_camera_nadir(), {0, 0, 60.0}};
    const auto depth =
        renderer->render_depth(CameraRequest::still(fisheye, pose, 0, PixelFormat::kGrey8));
    ASSERT_TRUE(depth.ok()) << depth.error().message;
    for (int y = 0; y < 300; ++y) {
      for (int x = 0; x < 300; ++x) {
        // Up to 86 deg the ground is less than 1 km away.
        if (std::hypot(x - 149.5, y - 149.5) / 138.0 > 1.5) continue;
        ASSERT_NEAR(depth->at(x, y), 60.0, 0.1) << x << ' ' << y;
      }
    }
  }
}

}  // namespace
}  // namespace overfly::renderer
