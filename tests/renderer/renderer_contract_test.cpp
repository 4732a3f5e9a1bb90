// What every Renderer does, whatever draws it.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/motion/pose.hpp"
#include "renderer/renderer.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer {
namespace {

using overfly::testing::natural_ground;
using overfly::testing::ProceduralGround;

Pose nadir_pose(double east_m, double north_m, double up_m, const RollPitchYaw& attitude = {}) {
  return {R_world_body_from(attitude) * R_body_camera_nadir(), {east_m, north_m, up_m}};
}

class RendererContract : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    camera_ = PinholeCamera::from_fov(320, 240, rad_from_deg(84.872), FovAxis::kHorizontal).value();
    renderer_ = create(natural_ground());
    if (renderer_ != nullptr) return;
    const auto egl = probe_egl();
    ASSERT_FALSE(egl.ok()) << "EGL works here, yet the renderer did not start";
    GTEST_SKIP() << "no EGL here: " << egl.error().message;
  }

  static std::unique_ptr<Renderer> create(std::shared_ptr<const terrain::TileSource> tiles) {
    if (std::string(GetParam()) == "noop") return create_noop_renderer(std::move(tiles));
    RendererOptions options;
    options.camera_backend =
        std::string(GetParam()) == "raycast" ? CameraBackend::kRaycast : CameraBackend::kEgl;
    auto renderer = create_renderer(std::move(tiles), options);
    return renderer.ok() ? std::move(*renderer) : nullptr;
  }

  PinholeCamera camera_;
  std::unique_ptr<Renderer> renderer_;
};

TEST_P(RendererContract, FrameCarriesItsRequest) {
  const Pose pose = nadir_pose(10.0, -20.0, 250.0, {0.2, -0.1, 1.0});
  const auto frame = renderer_->render_camera(camera_, pose, 1234, PixelFormat::kGrey8);
  ASSERT_TRUE(frame.ok()) << frame.error().message;
  EXPECT_EQ(frame->t_ns, 1234);
  EXPECT_EQ(frame->T_world_camera.translation, pose.translation);
  EXPECT_EQ(frame->T_world_camera.rotation.coeffs(), pose.rotation.coeffs());
  EXPECT_EQ(frame->camera.pinhole().fx_px, camera_.fx_px);
  EXPECT_EQ(frame->image.width_px, 320);
  EXPECT_EQ(frame->image.height_px, 240);
  EXPECT_EQ(frame->image.channels, 1);
  EXPECT_EQ(frame->image.data.size(), 320U * 240U);
}

TEST_P(RendererContract, ColourFramesHaveThreeChannels) {
  const auto frame =
      renderer_->render_camera(camera_, nadir_pose(0, 0, 250), 0, PixelFormat::kRgb8);
  ASSERT_TRUE(frame.ok()) << frame.error().message;
  EXPECT_EQ(frame->image.channels, 3);
  EXPECT_EQ(frame->image.data.size(), 320U * 240U * 3U);
}

TEST_P(RendererContract, EqualRequestsGiveEqualBytesWhateverCameBetween) {
  const Pose pose = nadir_pose(-100.0, 50.0, 180.0, {0.7, 0.1, -2.0});
  const auto first = renderer_->render_camera(camera_, pose, 0, PixelFormat::kGrey8);
  ASSERT_TRUE(first.ok());
  PinholeCamera other = camera_;
  other.width_px = 200;
  for (int i = 0; i < 5; ++i) {
    const Pose elsewhere =
        nadir_pose(90.0 * i, -70.0 * i, 60.0 + 80.0 * i, {0.1 * i, 0.0, i * 1.0});
    ASSERT_TRUE(renderer_->render_camera(other, elsewhere, i, PixelFormat::kRgb8).ok());
    ASSERT_TRUE(renderer_->render_depth(other, elsewhere).ok());
  }
  const auto again = renderer_->render_camera(camera_, pose, 0, PixelFormat::kGrey8);
  ASSERT_TRUE(again.ok());
  EXPECT_EQ(first->image.data, again->image.data);
  EXPECT_EQ(first->void_fraction, again->void_fraction);
  EXPECT_EQ(first->texels_per_pixel_median, again->texels_per_pixel_median);
  EXPECT_EQ(first->axis_depth_m, again->axis_depth_m);
}

TEST_P(RendererContract, DifferentPosesGiveDifferentImages) {
  const auto a = renderer_->render_camera(camera_, nadir_pose(0, 0, 250), 0, PixelFormat::kGrey8);
  const auto b = renderer_->render_camera(camera_, nadir_pose(9, 0, 250), 0, PixelFormat::kGrey8);
  ASSERT_TRUE(a.ok() && b.ok());
  EXPECT_NE(a->image.data, b->image.data);
}

TEST_P(RendererContract, TexelsPerPixelFollowHeightAndImagery) {
  // Flat ground of 0.5 m texels seen straight down: height / focal length / 0.5 everywhere.
  ProceduralGround::Options options;
  options.paint = overfly::testing::natural_paint;
  const auto flat = create(std::make_shared<ProceduralGround>(options));
  for (const double height_m : {50.0, 200.0, 400.0}) {
    const auto frame =
        flat->render_camera(camera_, nadir_pose(0, 0, height_m), 0, PixelFormat::kGrey8);
    ASSERT_TRUE(frame.ok());
    const double expected = height_m / camera_.fx_px / 0.5;
    EXPECT_NEAR(frame->texels_per_pixel_median, expected, 0.01 * expected);
    EXPECT_NEAR(frame->texels_per_pixel_min, expected, 0.01 * expected);
    EXPECT_EQ(frame->void_fraction, 0.0);
    ASSERT_TRUE(frame->axis_depth_m.has_value());
    EXPECT_NEAR(*frame->axis_depth_m, height_m, 2e-3);
  }
}

TEST_P(RendererContract, TexelsPerPixelLeaveOutSyntheticLevels) {
  // Two levels of synthetic detail above a photograph of 2 m.
  ProceduralGround::Options options;
  options.paint = overfly::testing::natural_paint;
  options.real_texel_m = 2.0;
  const auto detailed = create(std::make_shared<ProceduralGround>(options));
  const auto frame =
      detailed->render_camera(camera_, nadir_pose(0, 0, 200.0), 0, PixelFormat::kGrey8);
  ASSERT_TRUE(frame.ok());
  const double expected = 200.0 / camera_.fx_px / 2.0;
  EXPECT_NEAR(frame->texels_per_pixel_median, expected, 0.01 * expected);
  EXPECT_NEAR(frame->texels_per_pixel_min, expected, 0.01 * expected);
}

TEST_P(RendererContract, ReportsHeightsThatCouldNotBeRead) {
  ProceduralGround::Options options;
  options.paint = overfly::testing::natural_paint;
  options.heights_fail = true;
  const auto broken = create(std::make_shared<ProceduralGround>(options));
  const auto frame = broken->render_camera(camera_, nadir_pose(0, 0, 200), 0, PixelFormat::kGrey8);
  ASSERT_FALSE(frame.ok());
  EXPECT_EQ(frame.error().code, ErrorCode::kIo);
  const auto depth = broken->render_depth(camera_, nadir_pose(0, 0, 200));
  ASSERT_FALSE(depth.ok());
  EXPECT_EQ(depth.error().code, ErrorCode::kIo);
}

TEST_P(RendererContract, VoidFractionIsHalfAtTheEdgeOfTheImagery) {
  ProceduralGround::Options options;
  options.paint = overfly::testing::natural_paint;
  const auto flat = create(std::make_shared<ProceduralGround>(options));
  const double edge_m = 0.5 * 8 * 512 * 0.5;
  const auto frame =
      flat->render_camera(camera_, nadir_pose(edge_m, 0, 200), 0, PixelFormat::kGrey8);
  ASSERT_TRUE(frame.ok());
  EXPECT_NEAR(frame->void_fraction, 0.5, 1.0 / 40.0);
  const auto outside =
      flat->render_camera(camera_, nadir_pose(3 * edge_m, 0, 200), 0, PixelFormat::kGrey8);
  ASSERT_TRUE(outside.ok());
  EXPECT_EQ(outside->void_fraction, 1.0);
  EXPECT_EQ(outside->texels_per_pixel_median, 0.0);
  EXPECT_EQ(outside->texels_per_pixel_min, 0.0);
}

TEST_P(RendererContract, AxisDepthIsAlongAnObliqueAxis) {
  ProceduralGround::Options options;
  options.paint = overfly::testing::natural_paint;
  const auto flat = create(std::make_shared<ProceduralGround>(options));
  const Pose banked = nadir_pose(20.0, -30.0, 100.0, {rad_from_deg(45.0), 0.0, 0.6});
  const auto frame = flat->render_camera(camera_, banked, 0, PixelFormat::kGrey8);
  ASSERT_TRUE(frame.ok()) << frame.error().message;
  ASSERT_TRUE(frame->axis_depth_m.has_value());
  EXPECT_NEAR(*frame->axis_depth_m, 100.0 * std::sqrt(2.0), 0.01);
}

TEST_P(RendererContract, AxisDepthIsEmptyInTheSky) {
  const Pose level = {
      R_world_body_from({0.0, 0.4, 0.0}) *
          Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * kPi, Eigen::Vector3d::UnitY())) *
          Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * kPi, Eigen::Vector3d::UnitZ())),
      {0, 0, 300}};
  const auto frame = renderer_->render_camera(camera_, level, 0, PixelFormat::kGrey8);
  ASSERT_TRUE(frame.ok());
  EXPECT_FALSE(frame->axis_depth_m.has_value());
}

TEST_P(RendererContract, DepthHasTheImagesSizeAndTheAxisDepth) {
  const Pose pose = nadir_pose(30.0, 40.0, 300.0);
  const auto depth = renderer_->render_depth(camera_, pose);
  ASSERT_TRUE(depth.ok()) << depth.error().message;
  EXPECT_EQ(depth->width_px, 320);
  EXPECT_EQ(depth->height_px, 240);
  const auto frame = renderer_->render_camera(camera_, pose, 0, PixelFormat::kGrey8);
  ASSERT_TRUE(frame.ok() && frame->axis_depth_m.has_value());
  EXPECT_NEAR(depth->at(160, 120), *frame->axis_depth_m, 0.5);
}

TEST_P(RendererContract, RefusesBadCameras) {
  const auto message = [&](const PinholeCamera& camera) {
    const auto frame =
        renderer_->render_camera(camera, nadir_pose(0, 0, 200), 0, PixelFormat::kGrey8);
    EXPECT_FALSE(frame.ok());
    if (frame.ok()) return std::string();
    EXPECT_EQ(frame.error().code, ErrorCode::kInvalidArgument);
    EXPECT_FALSE(renderer_->render_depth(camera, nadir_pose(0, 0, 200)).ok());
    return frame.error().message;
  };
  PinholeCamera bad = camera_;
  bad.fx_px = -1.0;
  EXPECT_NE(message(bad).find("fx_px"), std::string::npos);
  bad = camera_;
  bad.width_px = 0;
  EXPECT_NE(message(bad).find("width_px"), std::string::npos);
  bad = camera_;
  bad.height_px = 10000;
  EXPECT_NE(message(bad).find("8192"), std::string::npos);
}

TEST_P(RendererContract, RefusesBadPoses) {
  const auto code = [&](const Pose& pose) {
    const auto frame = renderer_->render_camera(camera_, pose, 0, PixelFormat::kGrey8);
    return frame.ok() ? std::string("accepted") : std::string(to_string(frame.error().code));
  };
  EXPECT_EQ(code(nadir_pose(std::nan(""), 0, 200)), "invalid_argument");
  Pose bad = nadir_pose(0, 0, 200);
  bad.rotation.coeffs() *= 2.0;
  EXPECT_EQ(code(bad), "invalid_argument");
  const double ground_m = overfly::testing::hills_m(0, 0);
  EXPECT_EQ(code(nadir_pose(0, 0, ground_m - 1.5)), "invalid_argument");
  EXPECT_EQ(code(nadir_pose(0, 0, ground_m - 0.5)), "accepted");
}

TEST_P(RendererContract, SceneHasTheViewsSize) {
  SceneView view;
  view.width_px = 320;
  view.height_px = 200;
  view.T_world_camera = nadir_pose(0, 0, 400);
  const auto image = renderer_->render_scene(view, {});
  if (const auto egl = probe_egl(); !egl.ok() && std::string(GetParam()) == "raycast") {
    ASSERT_FALSE(image.ok());
    EXPECT_EQ(image.error().code, ErrorCode::kUnsupported);
    GTEST_SKIP() << "no EGL here: " << egl.error().message;
  }
  ASSERT_TRUE(image.ok()) << image.error().message;
  EXPECT_EQ(image->width_px, 320);
  EXPECT_EQ(image->height_px, 200);
  EXPECT_EQ(image->channels, 3);
  view.fov_y_rad = 4.0;
  const auto bad = renderer_->render_scene(view, {});
  ASSERT_FALSE(bad.ok());
  EXPECT_NE(bad.error().message.find("fov_y_rad"), std::string::npos);
}

TEST_P(RendererContract, InfoNamesTheBackend) {
  EXPECT_EQ(renderer_->info().backend, GetParam());
  EXPECT_FALSE(renderer_->info().device.empty());
}

INSTANTIATE_TEST_SUITE_P(Renderers,
                         RendererContract,
                         ::testing::Values("egl", "raycast", "noop"),
                         [](const auto& suite) { return std::string(suite.param); });

}  // namespace
}  // namespace overfly::renderer
