// A placed pinhole view against projections of single points, and rays onto the ground.
#include "renderer/ground/view.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "renderer/ground/ground_ray.hpp"
#include "renderer/ground/ground_reach.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer {
namespace {

const PinholeCamera kSkewed{120, 90, 80.0, 95.0, 50.0, 52.0};

View turned_view() {
  return View::from(kSkewed, {R_world_body_from({0.4, -0.3, 2.0}), {100.0, 200.0, 300.0}});
}

TEST(View, OutcodesAndSidePlanesTellTheImagesSides) {
  const View view = turned_view();
  const auto normals = view.side_normals_world();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int inside = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Eigen::Vector3d p(unit(random), unit(random), 0.6 + unit(random));
    const unsigned code = view.outcode(p);
    EXPECT_EQ((code & 16U) != 0, p.z() <= 0.0);
    if (p.z() <= 0.0) continue;
    const Eigen::Vector2d pixel = kSkewed.project(p).value();
    EXPECT_EQ((code & 1U) != 0, pixel.x() < -0.5);
    EXPECT_EQ((code & 2U) != 0, pixel.x() > 119.5);
    EXPECT_EQ((code & 4U) != 0, pixel.y() < -0.5);
    EXPECT_EQ((code & 8U) != 0, pixel.y() > 89.5);
    inside += code == 0 ? 1 : 0;
    // The same by the planes, through the world.
    const Eigen::Vector3d p_world = view.R_camera_world.transpose() * p + view.position_world;
    EXPECT_LT((view.camera_from_world(p_world) - p).norm(), 1e-12);
    for (std::size_t side = 0; side < 4; ++side) {
      EXPECT_EQ(normals[side].dot(p_world - view.position_world) < 0.0, (code >> side & 1U) != 0);
    }
  }
  EXPECT_GT(inside, 100);
}

TEST(View, PixelRatesAreDerivatives) {
  const View view = turned_view();
  const Eigen::Vector3d p(1.0, -2.0, 7.0), d(0.3, 0.4, -0.5);
  constexpr double kStep = 1e-5;
  const Eigen::Vector2d rate =
      (*kSkewed.project(p + kStep * d) - *kSkewed.project(p - kStep * d)) / (2.0 * kStep);
  EXPECT_LT((view.pixel_rate(p, d) - rate).norm(), 1e-7);
}

TEST(GroundRay, MeetsAPlaneAndASlope) {
  const FlatGround flat(50.0);
  const Eigen::Vector3d from(10.0, 20.0, 150.0);
  for (const double descent : {0.05, 0.3, 1.0}) {
    const double level = std::sqrt(1.0 - descent * descent);
    const auto hit = cast_to_ground(flat, from, {0.6 * level, 0.8 * level, -descent}, 1e4);
    ASSERT_TRUE(hit.has_value());
    const double range_m = 100.0 / descent;
    EXPECT_NEAR((*hit - from).norm(), range_m, 0.011);
    EXPECT_LE(hit->z(), 50.0);
  }
  EXPECT_FALSE(cast_to_ground(flat, from, {0.0, 0.8, 0.6}, 1e4).has_value()) << "the sky";
  EXPECT_FALSE(cast_to_ground(flat, from, {0.0, 0.0, -1.0}, 99.0).has_value()) << "too far";
  EXPECT_TRUE(cast_to_ground(flat, from, {0.0, 0.0, -1.0}, 101.0).has_value());
  EXPECT_EQ(*cast_to_ground(flat, {0.0, 0.0, 40.0}, {0.0, 0.0, 1.0}, 10.0),
            Eigen::Vector3d(0.0, 0.0, 40.0))
      << "below the ground";
}

TEST(GroundRay, RefinesADepthToAMillimetreAndKeepsItAtAFold) {
  const auto hills = overfly::testing::natural_ground();
  const Eigen::Vector3d from(5.0, -7.0, 200.0), direction(0.4, 0.5, -1.0);
  const auto hit = cast_to_ground(*hills, from, direction.normalized(), 1e4);
  ASSERT_TRUE(hit.has_value());
  const double depth_m = (*hit - from).norm() / direction.norm();
  for (const double guess : {0.99, 1.0, 1.01}) {
    const double refined_m = refine_depth(*hills, from, direction, guess * depth_m);
    const Eigen::Vector3d p = from + refined_m * direction;
    EXPECT_NEAR(p.z(), hills->ground_up_m(p.x(), p.y()), 1e-3);
  }
  // A wall of 60 m: the model's ground, at its foot, is far from the ground at its top.
  overfly::testing::ProceduralGround::Options options;
  options.height_m = [](double east_m, double) { return east_m < 100.0 ? 0.0 : 60.0; };
  const overfly::testing::ProceduralGround wall(options);
  EXPECT_EQ(refine_depth(wall, {0.0, 0.0, 200.0}, {0.6, 0.0, -1.0}, 190.0), 190.0);
}

TEST(GroundReach, IsTheDistanceOfTheHorizon) {
  // Published: 3.57 km times the root of the eye's height in metres.
  EXPECT_NEAR(horizon_m(1.0, 0.0), 3570.0, 2.0);
  EXPECT_NEAR(horizon_m(100.0, 400.0), 35700.0 + 71400.0, 60.0);
  EXPECT_EQ(horizon_m(1e9, 0.0), kMaxReachM);
}

}  // namespace
}  // namespace overfly::renderer
