#include "odometry/feature/map/map.hpp"

#include <gtest/gtest.h>

#include "odometry/feature/tracker.hpp"
#include "odometry/geometry/two_view.hpp"
#include "tests/odometry/test_camera.hpp"

namespace overfly::odometry::feature {
namespace {

/// Three keyframes; point i is seen by keyframe 0 and 1, every third one by keyframe 2 as well.
Map small_map(int points) {
  Map map;
  for (int i = 0; i < 3; ++i) map.add_keyframe({});
  for (int i = 0; i < points; ++i) {
    const int id = map.add_point({}).id;
    for (int keyframe = 0; keyframe < (i % 3 == 0 ? 3 : 2); ++keyframe) {
      map.add_observation(map.keyframe(keyframe), {id, {}, 1.0});
    }
  }
  return map;
}

TEST(Map, RanksCovisibleKeyframesByWhatTheyShare) {
  const Map map = small_map(30);
  EXPECT_EQ(map.covisible(0, 1), (std::vector<int>{1, 2}));
  EXPECT_EQ(map.covisible(0, 15), (std::vector<int>{1}));
  EXPECT_EQ(map.covisible(2, 1), (std::vector<int>{1, 0}));
}

TEST(Map, DropsAPointThatLosesAllButOneSight) {
  Map map = small_map(3);
  map.remove_observation(1, 1);
  EXPECT_EQ(map.point(1), nullptr);
  EXPECT_EQ(map.keyframe(0).observations.size(), 2U);
  map.remove_observation(1, 0);  // keyframes 0 and 2 still see it
  ASSERT_NE(map.point(0), nullptr);
  EXPECT_EQ(map.point(0)->keyframes, (std::vector<int>{0, 2}));
}

TEST(Map, ForgetsOldImagesAndWhatHangsOnThem) {
  Map map = small_map(4);
  MapPoint young;
  young.source_keyframe = 2;
  const int id = map.add_point(young).id;
  map.add_observation(map.keyframe(1), {id, {}, 1.0});
  map.add_observation(map.keyframe(2), {id, {}, 1.0});
  map.forget_images(1);
  EXPECT_EQ(map.points().size(), 1U);
  ASSERT_NE(map.point(id), nullptr);
  // Keyframe 0 sees nothing any more; 1 has no image, but still a sight.
  ASSERT_EQ(map.keyframes().size(), 2U);
  EXPECT_EQ(map.keyframes().begin()->first, 1);
}

TEST(Map, CountsTheMemoryOfItsImagesToo) {
  Map map = small_map(30);
  const std::size_t without = map.memory_bytes();
  EXPECT_EQ(map.image_bytes(), 0U);
  map.newest().pyramid = build_pyramid(std::make_shared<const Image>(64, 64, 1));
  EXPECT_EQ(map.image_bytes(), 64U * 64U + 32U * 32U);
  EXPECT_EQ(map.memory_bytes(), without + map.image_bytes());
}

TEST(GroundPlane, IsFittedDespiteOutliers) {
  Map map;
  Keyframe& keyframe = map.add_keyframe({});
  map.add_keyframe({});
  const Eigen::Vector3d truth(0.1, -0.2, 0.8);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d pixel(100.0 + 11.0 * i, 60.0 + (67 * i) % 800);
    const Eigen::Vector3d ray = camera().ray(pixel);
    MapPoint point;
    point.position_vo = ray / truth.dot(ray) * (i % 10 == 0 ? 0.6 : 1.0);
    const int id = map.add_point(point).id;
    map.add_observation(keyframe, {id, pixel, 1.0});
  }
  fit_plane(camera(), map, keyframe);
  EXPECT_LT((keyframe.plane.coefficients - truth).norm(), 0.01);
}

TEST(AxisDepth, IsThePlanesOnTheAxisHoweverTilted) {
  // Points over the whole image, more of them far than near, on a plane at 2 along the axis.
  const Eigen::Vector3d plane(0.1, -0.35, 0.5);
  const Pose T_camera_vo{exp_so3({0.3, 0.1, -0.2}), {0.1, 0.2, 0.3}};
  std::vector<Eigen::Vector3d> points;
  for (int y = 0; y < 960; y += 20 + y / 20) {
    for (int x = 10; x < 1280; x += 40) {
      const Eigen::Vector3d ray = camera().ray({1.0 * x, 1.0 * y});
      const double wrong = (x + y) % 7 == 0 ? 1.4 : 1.0;
      points.push_back(T_camera_vo.inverse() * (wrong * ray / plane.dot(ray)));
    }
  }
  EXPECT_NEAR(*axis_depth(T_camera_vo, points), 2.0, 0.01);
}

TEST(AxisDepth, IsTheMedianWhereFewPointsAreNearTheAxis) {
  std::vector<Eigen::Vector3d> points(5, Eigen::Vector3d(0.0, 0.0, 2.0));
  for (int i = 0; i < 200; ++i) points.emplace_back(3.0, 0.0, 4.0);
  EXPECT_DOUBLE_EQ(*axis_depth(Pose{}, points), 4.0);
  points.emplace_back(0.0, 0.0, -1.0);
  EXPECT_DOUBLE_EQ(*axis_depth(Pose{}, points), 4.0);
  EXPECT_FALSE(axis_depth(Pose{}, {}));
  EXPECT_FALSE(axis_depth(Pose{}, {{0.0, 0.0, -1.0}}));
}

TEST(PatchWarp, IsThePlanesMapFromTheOtherViewToTheSource) {
  const PinholeCamera camera{1280, 960, 700.0, 650.0, 639.5, 479.5};
  Keyframe source;
  source.T_camera_vo = {exp_so3({0.1, -0.1, 0.3}), {0.05, 0.02, 0.1}};
  source.plane.coefficients = {0.1, -0.2, 0.9};
  const Pose T_other_vo{exp_so3({0.5, 0.3, 0.4}), {0.1, -0.05, 0.15}};
  // Where the other view sees the plane that a pixel of the source sees.
  const auto point_at = [&](const Eigen::Vector2d& pixel) -> Eigen::Vector3d {
    const Eigen::Vector3d ray = camera.ray(pixel);
    return source.T_camera_vo.inverse() * (ray / source.plane.inverse_depth(ray));
  };
  MapPoint point;
  point.source_pixel = {800.0, 300.0};
  point.position_vo = point_at(point.source_pixel);
  set_normal(camera, source, point);
  const PatchWarp warp = warp_of(camera, T_other_vo, source, point);
  const Eigen::Vector2d middle = *camera.project(T_other_vo * point.position_vo);
  for (const double x : {-48.0, 0.0, 48.0}) {
    for (const double y : {-48.0, 0.0, 48.0}) {
      const Eigen::Vector2d offset(x, y);
      const Eigen::Vector2d other =
          *camera.project(T_other_vo * point_at(point.source_pixel + offset));
      const Eigen::Vector2d d = other - middle;
      const Eigen::Vector2d back = warp.A_source_other * d / (1.0 + warp.g_per_px.dot(d));
      EXPECT_LT((back - offset).norm(), 1e-9) << x << ", " << y;
    }
  }
}

TEST(PatchWarp, OfAHomographyIsTheHomography) {
  Eigen::Matrix3d H_source_other;
  H_source_other << 1.1, 0.2, -30.0, -0.1, 0.9, 12.0, 2e-4, -3e-4, 1.2;
  const Eigen::Vector2d middle(400.0, 300.0);
  const PatchWarp warp = warp_around(H_source_other, middle);
  const Eigen::Vector2d d(30.0, -20.0);
  const Eigen::Vector2d offset =
      transfer(H_source_other, middle + d) - transfer(H_source_other, middle);
  EXPECT_LT((warp.A_source_other * d / (1.0 + warp.g_per_px.dot(d)) - offset).norm(), 1e-9);
}

}  // namespace
}  // namespace overfly::odometry::feature
