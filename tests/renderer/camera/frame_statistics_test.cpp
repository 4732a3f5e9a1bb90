// A frame's statistics above a plane, against rays cut with the plane.
#include "renderer/camera/frame_statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "renderer/renderer.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer {
namespace {

constexpr double kPlaneTexelM = 0.5;
constexpr double kHalfWorldM = 1024.0;

std::shared_ptr<const terrain::TileSource> level_ground() {
  overfly::testing::ProceduralGround::Options options;
  options.curved = false;
  options.paint = [](double, double) { return 100.0; };
  return std::make_shared<overfly::testing::ProceduralGround>(options);
}

struct Expected {
  std::vector<double> texels_per_px;  ///< of rays that meet imagery, sorted
  int void_rays = 0;
};

/// Cuts the 40 x 30 rays with the plane z = 0. The texels of a pixel are the area of the ground
/// between four rays around its centre.
Expected cut_with_plane(const CameraModel& camera, const Pose& pose) {
  constexpr double kHalfPx = 0.01;
  Expected expected;
  const auto ground = [&](double x, double y) -> std::optional<Eigen::Vector2d> {
    const auto ray = camera.ray({x, y});
    if (!ray) return std::nullopt;
    const Eigen::Vector3d direction = pose.rotation * *ray;
    if (direction.z() >= 0.0) return std::nullopt;
    const Eigen::Vector3d p = pose.translation - pose.translation.z() / direction.z() * direction;
    return Eigen::Vector2d(p.head<2>());
  };
  const PinholeCamera& size = camera.pinhole();
  for (int row = 0; row < 30; ++row) {
    for (int column = 0; column < 40; ++column) {
      const double x = (column + 0.5) * size.width_px / 40.0 - 0.5;
      const double y = (row + 0.5) * size.height_px / 30.0 - 0.5;
      const auto at = ground(x, y), a = ground(x - kHalfPx, y), b = ground(x + kHalfPx, y);
      const auto c = ground(x, y - kHalfPx), d = ground(x, y + kHalfPx);
      if (!at || !a || !b || !c || !d) continue;
      if (at->cwiseAbs().maxCoeff() >= kHalfWorldM) {
        ++expected.void_rays;
        continue;
      }
      const Eigen::Vector2d across = (*b - *a) / (2.0 * kHalfPx);
      const Eigen::Vector2d along = (*d - *c) / (2.0 * kHalfPx);
      const double area_m2 = std::abs(across.x() * along.y() - across.y() * along.x());
      expected.texels_per_px.push_back(std::sqrt(area_m2) / kPlaneTexelM);
    }
  }
  std::sort(expected.texels_per_px.begin(), expected.texels_per_px.end());
  return expected;
}

class FrameStatisticsOf : public ::testing::TestWithParam<const char*> {
 protected:
  static std::unique_ptr<Renderer> create() {
    return std::string(GetParam()) == "mesh" ? create_noop_renderer(level_ground())
                                             : create_raycast_renderer(level_ground());
  }
};

TEST_P(FrameStatisticsOf, TiltedViewsAreThoseOfThePlane) {
  const auto renderer = create();
  const PinholeCamera pinhole =
      PinholeCamera::from_fov(320, 240, rad_from_deg(70.0), FovAxis::kHorizontal).value();
  const CameraModel bent(pinhole, {DistortionModel::kRadtan, {-0.15, 0.03, 1e-3, -1e-3, 0.0}});
  struct Case {
    CameraModel camera;
    RollPitchYaw attitude;
    Eigen::Vector3d position;
  };
  for (const Case& view : {Case{pinhole, {0.0, 0.0, 0.3}, {10.0, 20.0, 250.0}},
                           Case{pinhole, {0.5, 0.0, 1.0}, {100.0, -50.0, 150.0}},
                           Case{pinhole, {0.0, 0.8, 2.0}, {0.0, 0.0, 300.0}},
                           Case{pinhole, {-0.3, 1.4, 0.0}, {-300.0, 0.0, 90.0}},
                           Case{pinhole, {0.2, 0.1, 0.5}, {1000.0, 980.0, 200.0}},
                           Case{bent, {0.4, -0.2, 0.7}, {30.0, 0.0, 180.0}},
                           Case{bent, {-0.9, 0.1, 0.7}, {-850.0, 100.0, 220.0}}}) {
    const Pose pose{R_world_body_from(view.attitude) * R_body_camera_nadir(), view.position};
    const Expected expected = cut_with_plane(view.camera, pose);
    ASSERT_GT(expected.texels_per_px.size(), 100U);
    const auto frame = renderer->render_camera(view.camera, pose, 0, PixelFormat::kGrey8);
    ASSERT_TRUE(frame.ok()) << frame.error().message;
    const double median = expected.texels_per_px[expected.texels_per_px.size() / 2];
    EXPECT_NEAR(frame->texels_per_pixel_min,
                expected.texels_per_px.front(),
                2e-3 * expected.texels_per_px.front());
    // Rays at the imagery's edge may fall on either side of it.
    EXPECT_NEAR(frame->texels_per_pixel_median, median, 0.01 * median);
    EXPECT_NEAR(frame->void_fraction, expected.void_rays / 1200.0, 2.5 / 1200.0);
    const double descent = -(pose.rotation * Eigen::Vector3d::UnitZ()).z();
    ASSERT_EQ(frame->axis_depth_m.has_value(), descent > 0.0);
    if (descent <= 0.0) continue;
    EXPECT_NEAR(*frame->axis_depth_m, view.position.z() / descent, 0.02);
  }
}

INSTANTIATE_TEST_SUITE_P(Measures,
                         FrameStatisticsOf,
                         ::testing::Values("mesh", "rays"),
                         [](const auto& suite) { return std::string(suite.param); });

TEST(FrameStatistics, TakesTheMiddleAndTheLeastOfItsRays) {
  const FrameStatistics odd = statistics_of_rays({5.0, 1.0, 3.0, 2.0, 4.0}, 0, *level_ground());
  EXPECT_EQ(odd.texels_per_pixel_median, 3.0);
  EXPECT_EQ(odd.texels_per_pixel_min, 1.0);
  EXPECT_EQ(odd.void_fraction, 0.0);
  const FrameStatistics none = statistics_of_rays({}, 300, *level_ground());
  EXPECT_EQ(none.texels_per_pixel_median, 0.0);
  EXPECT_EQ(none.texels_per_pixel_min, 0.0);
  EXPECT_EQ(none.void_fraction, 0.25);
  EXPECT_FALSE(none.axis_depth_m.has_value());
}

TEST(FrameStatistics, AsksForImageryByPlaceInATileWithItsBorder) {
  const auto tiles = level_ground();
  const ImageryQuery query = imagery_query(*tiles);
  const double border = 8.0 / 528.0;
  EXPECT_TRUE(query({0, 0, 0}, border + 1e-4, 0.5));
  EXPECT_FALSE(query({0, 0, 0}, border - 1e-4, 0.5)) << "left of the imagery";
  EXPECT_FALSE(query({0, 3, 0}, 0.5, border - 1e-4)) << "above it";
  EXPECT_TRUE(query({1, 3, 3}, 1.0 - border - 1e-4, 1.0 - border - 1e-4));
  EXPECT_FALSE(query({1, 3, 3}, 1.0 - border + 1e-4, 0.5)) << "right of it";
  EXPECT_FALSE(query({1, 3, 3}, 0.5, 1.0 - border + 1e-4)) << "below it";
}

}  // namespace
}  // namespace overfly::renderer
