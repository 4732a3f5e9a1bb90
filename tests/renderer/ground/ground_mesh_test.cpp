// The ground as it is drawn: whole, where the ground is, to the horizon, near or far from the
// origin.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <thread>

#include "renderer/ground/ground_mesh.hpp"
#include "renderer/ground/ground_ray.hpp"
#include "renderer/renderer.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer {
namespace {

using overfly::testing::ProceduralGround;

PinholeCamera vga_camera() {
  return PinholeCamera::from_fov(640, 480, rad_from_deg(84.872), FovAxis::kHorizontal).value();
}

Pose pose_at(double east_m, double north_m, double up_m, const RollPitchYaw& attitude) {
  return {R_world_body_from(attitude) * R_body_camera_nadir(), {east_m, north_m, up_m}};
}

class DrawnGround : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const auto egl = probe_egl(); !egl.ok()) GTEST_SKIP() << egl.error().message;
  }
  static std::unique_ptr<Renderer> renderer_of(std::shared_ptr<const terrain::TileSource> tiles) {
    return std::move(create_egl_renderer(std::move(tiles)).value());
  }
};

TEST_F(DrawnGround, HasNoGapsBetweenPatchesOfDifferentSize) {
  ProceduralGround::Options options;
  options.height_m = overfly::testing::hills_m;
  options.height_range_m = {-20.0, 20.0};
  options.paint = [](double, double) { return 255.0; };
  options.cols = options.rows = 24;
  const auto renderer = renderer_of(std::make_shared<ProceduralGround>(options));
  // Low, tilted views hold patches of many levels; the sky is not seen in any of them.
  for (const double up_m : {30.0, 60.0, 150.0, 500.0}) {
    for (const double yaw_rad : {0.1, 1.3, 2.9, 4.4}) {
      const auto frame = renderer->render_camera(
          vga_camera(), pose_at(7, -11, up_m, {0.45, 0.05, yaw_rad}), 0, PixelFormat::kGrey8);
      ASSERT_TRUE(frame.ok()) << frame.error().message;
      EXPECT_EQ(frame->void_fraction, 0.0);
      EXPECT_EQ(std::count(frame->image.data.begin(), frame->image.data.end(), 255),
                static_cast<std::ptrdiff_t>(frame->image.data.size()))
          << "from " << up_m << " m";
    }
  }
}

TEST_F(DrawnGround, LiesWithinATenthOfAPixelOfTheGround) {
  const auto tiles = overfly::testing::natural_ground();
  const auto renderer = renderer_of(tiles);
  for (const RollPitchYaw attitude : {RollPitchYaw{0, 0, 0}, RollPitchYaw{0.7, 0.1, 1.0}}) {
    const Pose pose = pose_at(40, 90, 250, attitude);
    const View view = View::from(vga_camera(), pose);
    const auto depth = renderer->render_depth(vga_camera(), pose);
    ASSERT_TRUE(depth.ok());
    int measured = 0;
    for (int y = 3; y < 480; y += 13) {
      for (int x = 5; x < 640; x += 17) {
        const double depth_m = depth->at(x, y);
        const Eigen::Vector3d p_camera = depth_m * vga_camera().ray({x, y});
        const Eigen::Vector3d p = pose * p_camera;
        // Beyond the imagery the mesh is coarser.
        const Eigen::Vector2d map = tiles->map_from_world(p.x(), p.y());
        if (!std::isfinite(depth_m) || !tiles->has_imagery(map.x(), map.y())) continue;
        const double above_m = p.z() - tiles->ground_up_m(p.x(), p.y());
        const Eigen::Vector3d up_camera = view.R_camera_world.col(2);
        EXPECT_LT(view.pixel_rate(p_camera, above_m * up_camera).norm(), 0.1)
            << "at " << x << ", " << y;
        ++measured;
      }
    }
    EXPECT_GT(measured, 500);
  }
}

TEST_F(DrawnGround, EndsAtTheHorizonOfTheRoundEarth) {
  const auto tiles = overfly::testing::natural_ground();
  const auto renderer = renderer_of(tiles);
  // Level, forward looking: pitch the nadir camera up by 90 deg.
  const double up_m = 400.0;
  const auto frame = renderer->render_camera(
      vga_camera(), pose_at(0, 0, up_m, {0, 0.5 * kPi, 0}), 0, PixelFormat::kGrey8);
  ASSERT_TRUE(frame.ok());
  int first_ground_row = 0;
  while (frame->image.at(320, first_ground_row) == frame->image.at(320, 0)) ++first_ground_row;
  const double dip_rad = std::sqrt(2.0 * up_m / 6371000.0);
  // Hills of 20 m may lift the horizon by 0.2 px.
  EXPECT_NEAR(first_ground_row, vga_camera().cy_px + vga_camera().fy_px * std::tan(dip_rad), 1.2);
}

TEST_F(DrawnGround, LooksTheSameFarFromTheOrigin) {
  constexpr double kPeriodM = 4096.0;
  const auto periodic = [](double (*f)(double, double)) {
    return
        [f](double east_m, double north_m) { return f(std::remainder(east_m, kPeriodM), north_m); };
  };
  ProceduralGround::Options options;
  options.curved = false;
  options.height_m = periodic(overfly::testing::hills_m);
  options.height_range_m = {-20.0, 20.0};
  options.paint = periodic(overfly::testing::natural_paint);
  const auto near = renderer_of(std::make_shared<ProceduralGround>(options));
  options.centre_east_m = 24.0 * kPeriodM;  // 98 km
  const auto far = renderer_of(std::make_shared<ProceduralGround>(options));
  const RollPitchYaw attitude{0.3, 0.1, 0.7};
  const auto a =
      near->render_camera(vga_camera(), pose_at(12.3, 45.6, 120, attitude), 0, PixelFormat::kGrey8);
  const auto b = far->render_camera(vga_camera(),
                                    pose_at(options.centre_east_m + 12.3, 45.6, 120, attitude),
                                    0,
                                    PixelFormat::kGrey8);
  ASSERT_TRUE(a.ok() && b.ok());
  int worst = 0;
  for (std::size_t i = 0; i < a->image.data.size(); ++i) {
    worst = std::max(worst, std::abs(a->image.data[i] - b->image.data[i]));
  }
  EXPECT_LE(worst, 1);
}

TEST_F(DrawnGround, TilesAreReadOnceAndAgainOnlyWhenTheBudgetIsShort) {
  const auto tiles = overfly::testing::natural_ground();
  RendererOptions small;
  small.tile_cache_bytes = std::size_t{1} << 20U;  // less than one view
  const auto roomy = renderer_of(tiles);
  const Pose here = pose_at(-200, 0, 200, {}), there = pose_at(500, 500, 200, {});
  const auto first = roomy->render_camera(vga_camera(), here, 0, PixelFormat::kGrey8);
  ASSERT_TRUE(first.ok());
  ASSERT_TRUE(roomy->render_camera(vga_camera(), there, 0, PixelFormat::kGrey8).ok());
  const int read_once = tiles->tiles_read();
  ASSERT_TRUE(roomy->render_camera(vga_camera(), here, 0, PixelFormat::kGrey8).ok());
  EXPECT_EQ(tiles->tiles_read(), read_once);

  const auto cramped = create_egl_renderer(tiles, small);
  ASSERT_TRUE(cramped.ok());
  for (const Pose& pose : {here, there, here}) {
    const auto frame = (*cramped)->render_camera(vga_camera(), pose, 0, PixelFormat::kGrey8);
    ASSERT_TRUE(frame.ok());
    if (pose.translation == here.translation) {
      EXPECT_EQ(frame->image.data, first->image.data);
    }
  }
  EXPECT_GT(tiles->tiles_read(), 2 * read_once);
}

TEST_F(DrawnGround, UnreadableTilesAreAnErrorThatNamesThem) {
  ProceduralGround::Options options;
  options.paint = overfly::testing::natural_paint;
  options.failing_level = 0;
  const auto renderer = renderer_of(std::make_shared<ProceduralGround>(options));
  const auto frame =
      renderer->render_camera(vga_camera(), pose_at(0, 0, 100, {}), 0, PixelFormat::kGrey8);
  ASSERT_FALSE(frame.ok());
  EXPECT_EQ(frame.error().code, ErrorCode::kIo);
  EXPECT_NE(frame.error().message.find("the disk is gone"), std::string::npos);
  EXPECT_NE(frame.error().message.find("tile 0/"), std::string::npos);
}

TEST_F(DrawnGround, RenderersOnSeveralThreadsDrawTheSame) {
  const auto tiles = overfly::testing::natural_ground();
  const Pose pose = pose_at(10, 20, 200, {0.2, 0.1, 0.5});
  std::vector<Image> images(3);
  std::vector<std::thread> threads;
  for (Image& image : images) {
    threads.emplace_back([&image, &pose, tiles] {
      // Contexts come and go while others draw.
      (void)renderer_of(tiles);
      auto frame = renderer_of(tiles)->render_camera(vga_camera(), pose, 0, PixelFormat::kGrey8);
      if (frame.ok()) image = std::move(frame->image);
    });
  }
  for (std::thread& thread : threads) thread.join();
  ASSERT_FALSE(images[0].empty());
  EXPECT_EQ(images[0].data, images[1].data);
  EXPECT_EQ(images[0].data, images[2].data);
}

}  // namespace
}  // namespace overfly::renderer
