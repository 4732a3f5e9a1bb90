// What scene views show, measured in their images.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "renderer/renderer.hpp"
#include "renderer/tiles/tile_store.hpp"
#include "renderer/viewpoint.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer {
namespace {

class SceneView : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const auto egl = probe_egl(); !egl.ok()) GTEST_SKIP() << egl.error().message;
    overfly::testing::ProceduralGround::Options options;
    options.paint = [](double, double) { return 90.0; };  // neutral: colours are the content's
    tiles_ = std::make_shared<overfly::testing::ProceduralGround>(options);
    renderer_ = std::move(create_egl_renderer(tiles_).value());
  }

  Image draw(const Pose& T_world_camera, const SceneContent& content) {
    renderer::SceneView view;
    view.T_world_camera = T_world_camera;
    auto image = renderer_->render_scene(view, content);
    EXPECT_TRUE(image.ok());
    return image.ok() ? std::move(*image) : Image(1, 1, 3);
  }

  /// Pixels redder than anything else in a scene.
  static std::vector<cv::Point> red_pixels(const Image& image) {
    std::vector<cv::Point> pixels;
    for (int y = 0; y < image.height_px; ++y) {
      for (int x = 0; x < image.width_px; ++x) {
        if (image.at(x, y, 0) > 70 && image.at(x, y, 0) > 2 * image.at(x, y, 1) &&
            image.at(x, y, 0) > 2 * image.at(x, y, 2)) {
          pixels.emplace_back(x, y);
        }
      }
    }
    return pixels;
  }

  /// A straight flight to the north at 200 m with a constant bank.
  static Ribbon banked_ribbon(double roll_rad, int poses, double step_m) {
    Ribbon ribbon;
    for (int i = 0; i < poses; ++i) {
      ribbon.T_world_body.push_back(
          {R_world_body_from({roll_rad, 0.0, 0.0}), {0.0, i * step_m, 200.0}});
    }
    return ribbon;
  }

  std::shared_ptr<const terrain::TileSource> tiles_;
  std::unique_ptr<Renderer> renderer_;
};

TEST_F(SceneView, RibbonTiltsWithTheBank) {
  for (const double roll_deg : {0.0, 45.0, -30.0}) {
    SCOPED_TRACE(roll_deg);
    SceneContent content;
    content.ribbons.push_back(banked_ribbon(rad_from_deg(roll_deg), 200, 1.0));
    // Along the path from 25 m behind and 3 m above. Wings are square to the path, so that the
    // near end of the strip is seen undistorted: a line as steep as the bank.
    const Pose camera = look_at({0, -25, 203}, {0, 1000, 203}, {0, 0, 1});
    const std::vector<cv::Point> red = red_pixels(draw(camera, content));
    ASSERT_GT(red.size(), 500U);
    // The tips of the near end are the two points of the strip that lie farthest apart.
    std::vector<cv::Point> hull;
    cv::convexHull(red, hull);
    double longest_px = 0.0;
    cv::Point left, right;
    for (const cv::Point& a : hull) {
      for (const cv::Point& b : hull) {
        if (a.x < b.x && cv::norm(b - a) > longest_px) {
          longest_px = cv::norm(b - a);
          left = a;
          right = b;
        }
      }
    }
    // Right wing down for positive roll; image y points down.
    const double tilt_deg = deg_from_rad(std::atan2(right.y - left.y, right.x - left.x));
    EXPECT_NEAR(tilt_deg, roll_deg, 1.0);
    const double f_px = 0.5 * 720 / std::tan(0.45);
    EXPECT_NEAR(longest_px, f_px * 8.0 / 25.0, 4.0);
  }
}

TEST_F(SceneView, RibbonStaysVisibleFromAfar) {
  SceneContent content;
  content.ribbons.push_back(banked_ribbon(0.0, 100, 10.0));
  // 8 m seen edge-on from 6 km would be far below a pixel.
  const Pose camera = look_at({6000, 500, 260}, {0, 500, 200}, {0, 0, 1});
  const std::vector<cv::Point> red = red_pixels(draw(camera, content));
  ASSERT_FALSE(red.empty());
  const cv::Rect box = cv::boundingRect(red);
  const double f_px = 0.5 * 720 / std::tan(0.45);
  EXPECT_NEAR(box.width, f_px * 990.0 / 6000.0, 6.0);
  EXPECT_GE(static_cast<double>(red.size()) / box.width, 2.0);  // at least 2 px thick
}

TEST_F(SceneView, DenseRibbonsLookLikeSparseOnes) {
  SceneContent dense, sparse;
  dense.ribbons.push_back(banked_ribbon(0.5, 20001, 0.05));
  sparse.ribbons.push_back(banked_ribbon(0.5, 101, 10.0));
  const Pose camera = look_at({-300, 300, 320}, {0, 500, 200}, {0, 0, 1});
  const auto a = red_pixels(draw(camera, dense));
  const auto b = red_pixels(draw(camera, sparse));
  EXPECT_GT(a.size(), 500U);
  EXPECT_NEAR(static_cast<double>(a.size()), static_cast<double>(b.size()), 0.03 * b.size());
}

TEST_F(SceneView, AircraftIsWhereItsPoseIsAndAsWideAsItsWings) {
  SceneContent content;
  content.aircraft.push_back({{R_world_body_from({0, 0, 0}), {0, 0, 200}}, {1, 0, 0}, 8.0, false});
  const Pose camera = top_viewpoint({0, 0, 200}, 0.0, 40.0);
  const std::vector<cv::Point> red = red_pixels(draw(camera, content));
  ASSERT_GT(red.size(), 200U);
  const cv::Rect box = cv::boundingRect(red);
  // The red part of the wing spans 72 % of it; the tips are pale.
  const double f_px = 0.5 * 720 / std::tan(0.45);
  EXPECT_NEAR(box.width, 0.72 * 8.0 * f_px / 40.0, 5.0);
  EXPECT_NEAR(box.x + 0.5 * box.width, 480.0, 2.0);
  EXPECT_LT(std::abs(box.y + 0.5 * box.height - 360.0), 40.0);
}

TEST_F(SceneView, FootprintOutlinesTheImageOnTheGround) {
  SceneContent content;
  SceneContent::Frustum frustum;
  frustum.camera =
      PinholeCamera::from_fov(1280, 960, rad_from_deg(84.872), FovAxis::kHorizontal).value();
  frustum.T_world_camera = {R_body_camera_nadir(), {0, 0, 100}};
  frustum.T_world_camera.rotation = R_world_body_from({0, 0, 0}) * R_body_camera_nadir();
  content.frustum = frustum;
  const Image with = draw(top_viewpoint({0, 0, 0}, 0.0, 400.0), content);
  const Image without = draw(top_viewpoint({0, 0, 0}, 0.0, 400.0), {});
  std::vector<cv::Point> changed;
  for (int y = 0; y < with.height_px; ++y) {
    for (int x = 0; x < with.width_px; ++x) {
      if (std::abs(with.at(x, y, 0) - without.at(x, y, 0)) > 60) changed.emplace_back(x, y);
    }
  }
  ASSERT_FALSE(changed.empty());
  const cv::Rect box = cv::boundingRect(changed);
  const double f_px = 0.5 * 720 / std::tan(0.45);
  // 100 m above flat ground: 1280 / 700 x 100 m by 960 / 700 x 100 m, seen from 400 m.
  EXPECT_NEAR(box.width, f_px / 400.0 * 1280.0 / 7.00006, 4.0);
  EXPECT_NEAR(box.height, f_px / 400.0 * 960.0 / 7.00006, 4.0);
}

TEST_F(SceneView, ShowsHazeBeyondTheReachOfTheGround) {
  // From 1000 km, 50 deg down.
  const Pose high = look_at({0, 0, 1e6}, {0, 1e6 / std::tan(rad_from_deg(50.0)), 0}, {0, 0, 1});
  (void)draw(top_viewpoint({0, 0, 0}, 0.0, 400.0), {});
  const Image after_ground = draw(high, {});
  (void)draw(look_at({0, -25, 203}, {0, 1000, 203}, {0, 0, 1}), {});
  EXPECT_EQ(draw(high, {}).data, after_ground.data) << "nothing of the picture before";
  const int haze[] = {214, 227, 237};
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(after_ground.at(480, 100, c), haze[c], 1);
}

TEST_F(SceneView, ThatFailsLeavesNoLateTilesToTheNextPicture) {
  overfly::testing::ProceduralGround::Options options;
  options.paint = [](double, double) { return 90.0; };
  options.failing_level = 3;  // the coarsest
  const auto tiles = std::make_shared<overfly::testing::ProceduralGround>(options);
  RendererOptions shared;
  shared.tile_store = std::make_shared<TileStore>(tiles, TileStoreOptions{});
  // The west is there, coarsely; of the east there is nothing.
  for (const int row : {0, 1}) {
    ASSERT_TRUE(shared.tile_store->get({2, 0, row}, PixelFormat::kRgb8).ok());
  }
  const auto renderer = std::move(create_egl_renderer(tiles, shared).value());
  renderer::SceneView view;
  view.T_world_camera = top_viewpoint({0, 0, 0}, 0.0, 100.0);
  view.tile_wait_ns = 0;
  const auto image = renderer->render_scene(view, {});
  ASSERT_FALSE(image.ok());
  EXPECT_EQ(image.error().code, ErrorCode::kIo);
  const auto camera = PinholeCamera::from_fov(320, 240, 1.0, FovAxis::kHorizontal).value();
  const Pose west{R_world_body_from({}) * R_body_camera_nadir(), {-200.0, 100.0, 100.0}};
  const auto frame = renderer->render_camera(camera, west, 0, PixelFormat::kRgb8);
  ASSERT_TRUE(frame.ok()) << frame.error().message;
  EXPECT_EQ(frame->late_tiles, 0);
}

TEST_F(SceneView, ChaseKeepsTheAircraftInTheMiddleAndTheHorizonLevel) {
  const Pose body{R_world_body_from({0.6, 0.1, 2.0}), {50, 60, 200}};
  const Pose camera = chase_viewpoint(body, {0.0, 0.3, 100.0, 2.0}, *tiles_);
  const Eigen::Vector3d p_camera = camera.inverse() * body.translation;
  EXPECT_NEAR(p_camera.x(), 0.0, 1e-9);
  EXPECT_NEAR(p_camera.y(), 0.0, 1e-9);
  EXPECT_NEAR(p_camera.z(), 100.0, 1e-9);
  // The camera's x axis is level and it looks where the aircraft flies, 0.3 rad down.
  EXPECT_NEAR((camera.rotation * Eigen::Vector3d::UnitX()).z(), 0.0, 1e-12);
  const Eigen::Vector3d forward = camera.rotation * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(std::atan2(forward.x(), forward.y()), 2.0, 1e-9);
  EXPECT_NEAR(std::asin(-forward.z()), 0.3, 1e-9);
}

TEST_F(SceneView, ViewpointsStayAboveTheGround) {
  const Pose camera = orbit_viewpoint({0, 0, 20}, {0.0, -0.5, 100.0, 2.0}, *tiles_);
  EXPECT_GE(camera.translation.z(),
            tiles_->ground_up_m(camera.translation.x(), camera.translation.y()) + 2.0);
}

TEST_F(SceneView, IsTheSameWhateverViewsAreExpectedAndBadOnesAreLeftOut) {
  renderer::SceneView view;
  view.T_world_camera = orbit_viewpoint({0, 0, 20}, {0.0, 0.5, 100.0, 2.0}, *tiles_);
  const Image before = draw(view.T_world_camera, {});
  std::vector<renderer::SceneView> expected(5, view);
  expected[0].T_world_camera.translation.x() = std::numeric_limits<double>::quiet_NaN();
  expected[1].T_world_camera.translation.y() = 1e300;
  expected[2].T_world_camera.rotation.coeffs().setZero();
  expected[3].width_px = -1;
  renderer_->expect_scenes(expected);
  EXPECT_EQ(draw(view.T_world_camera, {}).data, before.data);
  EXPECT_TRUE(tiles_->status().ok());
}

}  // namespace
}  // namespace overfly::renderer
