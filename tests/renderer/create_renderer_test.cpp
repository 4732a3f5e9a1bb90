// Which renderer is made from the options, what it reports, and what it refuses.
#include <gtest/gtest.h>

#include "renderer/renderer.hpp"
#include "renderer/tiles/tile_store.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer {
namespace {

RendererOptions options_with(CameraBackend backend, const std::string& device = "") {
  RendererOptions options;
  options.camera_backend = backend;
  options.device = device;
  return options;
}

Pose scene_pose() { return {R_world_body_from({}) * R_body_camera_nadir(), {0.0, 0.0, 300.0}}; }

TEST(CreateRenderer, OnlyOpenGlAloneFailsWithADeviceThatIsNone) {
  const auto tiles = overfly::testing::natural_ground();
  const auto egl = create_renderer(tiles, options_with(CameraBackend::kEgl, "fastest"));
  ASSERT_FALSE(egl.ok());
  EXPECT_EQ(egl.error().code, ErrorCode::kInvalidArgument);
  EXPECT_NE(egl.error().message.find("\"fastest\""), std::string::npos);
  // The camera works without OpenGL; the reason is reported.
  const auto automatic = create_renderer(tiles, options_with(CameraBackend::kAuto, "fastest"));
  ASSERT_TRUE(automatic.ok());
  EXPECT_EQ((*automatic)->info().backend, "raycast");
  EXPECT_NE((*automatic)->info().camera_note.find("OpenGL does not work here"), std::string::npos);
  EXPECT_NE((*automatic)->info().camera_note.find("\"fastest\""), std::string::npos);
}

TEST(CreateRenderer, SceneViewsWithoutOpenGlAreRefusedAndTheCameraWorksOn) {
  const auto tiles = overfly::testing::natural_ground();
  const auto renderer = create_renderer(tiles, options_with(CameraBackend::kRaycast, "fastest"));
  ASSERT_TRUE(renderer.ok());
  EXPECT_EQ((*renderer)->info().camera_note, "the ray-caster was requested");
  SceneView view;
  view.T_world_camera = scene_pose();
  for (int i = 0; i < 2; ++i) {
    const auto image = (*renderer)->render_scene(view, {});
    ASSERT_FALSE(image.ok());
    EXPECT_NE(image.error().message.find("scene views need OpenGL"), std::string::npos);
    EXPECT_NE(image.error().message.find("\"fastest\""), std::string::npos);
  }
  const PinholeCamera camera{64, 48, 50.0, 50.0, 31.5, 23.5};
  EXPECT_TRUE((*renderer)->render_camera(camera, scene_pose(), 0, PixelFormat::kGrey8).ok());
  const auto alone = create_raycast_renderer(tiles)->render_scene(view, {});
  ASSERT_FALSE(alone.ok());
  EXPECT_EQ(alone.error().code, ErrorCode::kUnsupported);
}

TEST(CreateRenderer, RenderersShareAStoreOfTiles) {
  const auto tiles = overfly::testing::natural_ground();
  RendererOptions options = options_with(CameraBackend::kRaycast);
  options.tile_store = std::make_shared<TileStore>(tiles, TileStoreOptions{});
  const PinholeCamera camera{64, 48, 50.0, 50.0, 31.5, 23.5};
  Image images[2];
  int read[2] = {};
  for (int i = 0; i < 2; ++i) {
    const auto renderer = create_renderer(tiles, options);
    ASSERT_TRUE(renderer.ok());
    auto frame = (*renderer)->render_camera(camera, scene_pose(), 0, PixelFormat::kGrey8);
    ASSERT_TRUE(frame.ok());
    images[i] = std::move(frame->image);
    read[i] = tiles->tiles_read();
  }
  EXPECT_GT(read[0], 0);
  EXPECT_EQ(read[1], read[0]) << "read again for the second renderer";
  EXPECT_EQ(images[0].data, images[1].data);
}

TEST(CreateRenderer, ThreadsAreThoseOfTheOptions) {
  const auto tiles = overfly::testing::natural_ground();
  RendererOptions options = options_with(CameraBackend::kRaycast);
  options.threads = 1;
  EXPECT_NE(create_raycast_renderer(tiles, options)->info().device.find("1 thread,"),
            std::string::npos);
  options.threads = 3;
  EXPECT_NE(create_raycast_renderer(tiles, options)->info().device.find("3 threads,"),
            std::string::npos);
}

}  // namespace
}  // namespace overfly::renderer
