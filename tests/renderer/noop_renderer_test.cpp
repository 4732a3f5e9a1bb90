// The renderer without graphics: depth of a level plane, radiance of its own pattern.
#include <gtest/gtest.h>

#include <cmath>

#include "renderer/renderer.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer {
namespace {

TEST(NoopRenderer, DepthIsThatOfTheLevelPlaneBelow) {
  const auto hills = overfly::testing::natural_ground();
  const auto renderer = create_noop_renderer(hills);
  const PinholeCamera camera{65, 49, 40.0, 44.0, 32.0, 24.0};
  const Pose pose{R_world_body_from({0.9, 0.2, 1.0}) * R_body_camera_nadir(), {70.0, 30.0, 150.0}};
  const double height_m = 150.0 - hills->ground_up_m(70.0, 30.0);
  const auto depth = renderer->render_depth(camera, pose);
  ASSERT_TRUE(depth.ok());
  int ground = 0, sky = 0;
  for (int y = 0; y < 49; ++y) {
    for (int x = 0; x < 65; ++x) {
      const double z_m = depth->at(x, y);
      const Eigen::Vector3d direction = pose.rotation * camera.ray({x, y});
      if (std::isinf(z_m)) {
        EXPECT_GT(direction.z(), -1e-5);
        ++sky;
      } else {
        EXPECT_NEAR(z_m * direction.z(), -height_m, 1e-4 * height_m);
        ++ground;
      }
    }
  }
  EXPECT_GT(ground, 1000);
  EXPECT_GT(sky, 50);
}

TEST(NoopRenderer, RadianceIsItsPatternInBytes) {
  const auto renderer = create_noop_renderer(overfly::testing::natural_ground());
  const PinholeCamera camera{64, 48, 50.0, 50.0, 31.5, 23.5};
  const Pose pose{R_world_body_from({}) * R_body_camera_nadir(), {0.0, 0.0, 300.0}};
  const auto bytes = renderer->render_camera(camera, pose, 0, PixelFormat::kRgb8);
  const auto linear = renderer->render_camera(camera, pose, 0, PixelFormat::kRgbLinear);
  ASSERT_TRUE(bytes.ok() && linear.ok());
  EXPECT_TRUE(linear->image.empty() && bytes->radiance.empty());
  ASSERT_EQ(linear->radiance.data.size(), bytes->image.data.size());
  for (std::size_t i = 0; i < bytes->image.data.size(); ++i) {
    ASSERT_FLOAT_EQ(linear->radiance.data[i], static_cast<float>(bytes->image.data[i]) / 255.0F);
  }
}

}  // namespace
}  // namespace overfly::renderer
