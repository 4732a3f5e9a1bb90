// The triangles of a scene's objects, measured as points and pixels.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "renderer/scene/aircraft_mesh.hpp"
#include "renderer/scene/ribbon_mesh.hpp"
#include "renderer/scene/scene_triangles.hpp"

namespace overfly::renderer {
namespace {

const PinholeCamera kSceneCamera{400, 300, 250.0, 250.0, 199.5, 149.5};

View front_view() { return View::from(kSceneCamera, Pose{}); }

Eigen::Vector3d place(const SceneVertex& v) { return {v.x, v.y, v.z}; }
Eigen::Vector2d pixel_of(const SceneVertex& v) { return kSceneCamera.project(place(v)).value(); }

Eigen::AlignedBox2d pixel_box(const SceneTriangles& triangles) {
  Eigen::AlignedBox2d box;
  for (const SceneVertex& v : triangles.vertices()) box.extend(pixel_of(v));
  return box;
}

TEST(SceneTriangles, LinesHaveTheirWidthAtEveryDistance) {
  SceneTriangles triangles(front_view());
  const Eigen::Vector3d from(-2.0, 1.0, 10.0), to(3.0, -1.0, 40.0);
  triangles.add_line(from, to, 6.0, {});
  ASSERT_EQ(triangles.vertices().size(), 6U);
  const Eigen::Vector2d a = *kSceneCamera.project(from), b = *kSceneCamera.project(to);
  const Eigen::Vector2d along = (b - a).normalized();
  for (const SceneVertex& v : triangles.vertices()) {
    const Eigen::Vector2d end = std::abs(v.z - 10.0F) < 1e-4F ? a : b;
    const Eigen::Vector2d off = pixel_of(v) - end;
    EXPECT_NEAR(std::abs(off.x() * along.y() - off.y() * along.x()), 3.0, 1e-3);
    EXPECT_NEAR(off.dot(along), 0.0, 1e-3);
  }
}

TEST(SceneTriangles, LinesEndInFrontOfTheCamera) {
  SceneTriangles triangles(front_view());
  triangles.add_line({0.0, 0.0, 20.0}, {0.5, 0.0, -20.0}, 2.0, {});
  ASSERT_FALSE(triangles.vertices().empty());
  for (const SceneVertex& v : triangles.vertices()) {
    EXPECT_GT(v.z, 0.0F);
    // On the line, but for half its width.
    EXPECT_NEAR(v.x, 0.0125 * (20.0 - v.z), 1.01 * v.z / 250.0 + 1e-4);
  }
  SceneTriangles none(front_view());
  none.add_line({0.0, 0.0, -1.0}, {1.0, 0.0, -2.0}, 2.0, {});
  none.add_line({-100.0, 0.0, 10.0}, {-100.0, 5.0, 10.0}, 2.0, {});
  none.add_line({0.0, 0.0, 10.0}, {0.0, 0.0, 20.0}, 2.0, {});  // a point in the image
  none.add_triangle({9.0, 0.0, 1.0}, {9.0, 1.0, 1.0}, {8.0, 0.0, 1.0}, {});
  none.add_mark({0.0, 0.0, -5.0}, 4.0, {});
  EXPECT_TRUE(none.vertices().empty());
}

TEST(SceneTriangles, MarksAreSquaresOfTheirSize) {
  SceneTriangles triangles(front_view());
  triangles.add_mark({1.0, 2.0, 30.0}, 5.0, {});
  const Eigen::AlignedBox2d box = pixel_box(triangles);
  EXPECT_LT((box.center() - *kSceneCamera.project({1.0, 2.0, 30.0})).norm(), 1e-4);
  EXPECT_LT((box.sizes() - Eigen::Vector2d(5.0, 5.0)).norm(), 1e-4);
}

TEST(SceneTriangles, PulledNearerStayInPlaceInTheImage) {
  SceneTriangles triangles(front_view());
  triangles.add_mark({1.0, 2.0, 30.0}, 5.0, {});
  triangles.pull_nearer(0.1);
  triangles.add_mark({1.0, 2.0, 30.0}, 5.0, {});
  for (int i = 0; i < 6; ++i) {
    const SceneVertex &before = triangles.vertices()[i], &after = triangles.vertices()[i + 6];
    EXPECT_NEAR(after.z, 27.0, 1e-4);
    EXPECT_LT((pixel_of(after) - pixel_of(before)).norm(), 1e-4);
  }
}

TEST(SceneTriangles, ColoursAreRoundedAndClamped) {
  SceneTriangles triangles(front_view());
  triangles.add_mark({0.0, 0.0, 9.0}, 5.0, Rgba{0.5F, 1.7F, -0.3F, 0.25F});
  EXPECT_EQ(triangles.vertices()[0].rgba, (std::array<std::uint8_t, 4>{128, 255, 0, 64}));
  const Rgba dark = Rgba{0.5F, 1.0F, 0.2F, 0.7F}.shaded(0.5F);
  EXPECT_FLOAT_EQ(dark.g, 0.5F);
  EXPECT_FLOAT_EQ(dark.a, 0.7F) << "a shadow does not make it translucent";
}

TEST(Sunlight, IsBrightestTowardsTheSunAndNeverDark) {
  const Eigen::Vector3d sun = Eigen::Vector3d(-0.45, -0.55, 0.7).normalized();
  for (double azimuth = 0.0; azimuth < 6.3; azimuth += 0.3) {
    for (double height = -1.5; height < 1.6; height += 0.3) {
      const Eigen::Vector3d normal(std::cos(height) * std::sin(azimuth),
                                   std::cos(height) * std::cos(azimuth),
                                   std::sin(height));
      EXPECT_GT(sunlight(normal), 0.2F);
      EXPECT_LE(sunlight(normal), sunlight(sun));
    }
  }
  EXPECT_LE(sunlight(sun), 1.0F);
}

/// Seen from behind: the wings lie across the image.
SceneContent::Aircraft aircraft_ahead(double distance_m) {
  SceneContent::Aircraft aircraft;
  // Body forward = camera z, right = camera x, down = camera y.
  Eigen::Matrix3d R;
  R << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  aircraft.T_world_body = {Eigen::Quaterniond(R), {0.0, 0.0, distance_m}};
  return aircraft;
}

TEST(AircraftMesh, IsAsWideAsItsWingsAndSymmetric) {
  SceneTriangles triangles(front_view());
  add_aircraft(aircraft_ahead(50.0), 10.0, triangles);
  Eigen::AlignedBox3d box;
  for (const SceneVertex& v : triangles.vertices()) box.extend(place(v));
  EXPECT_NEAR(box.sizes().x(), 8.0, 1e-4);
  EXPECT_NEAR(box.center().x(), 0.0, 1e-4);
  // Nose to tail 0.7 spans; the fin rises above the wing.
  EXPECT_NEAR(box.sizes().z(), 0.72 * 8.0, 0.3);
  EXPECT_GT(box.max().z() - 50.0, 0.0);
  EXPECT_LT(-box.min().y(), 0.2 * 8.0);
}

TEST(AircraftMesh, IsEnlargedToStayVisibleAndGhostsAreTranslucent) {
  SceneContent::Aircraft aircraft = aircraft_ahead(5000.0);
  aircraft.ghost = true;
  SceneTriangles triangles(front_view());
  add_aircraft(aircraft, 24.0, triangles);
  EXPECT_NEAR(pixel_box(triangles).sizes().x(), 24.0, 0.5);
  for (const SceneVertex& v : triangles.vertices()) EXPECT_EQ(v.rgba[3], 115);
}

TEST(RibbonMesh, JoinsTheWingTipsAndMergesPosesThatLookTheSame) {
  const auto vertices = [](int poses, double step_m) {
    Ribbon ribbon;
    for (int i = 0; i < poses; ++i) {
      Pose pose = aircraft_ahead(0.0).T_world_body;
      pose.translation = {0.0, 3.0, 20.0 + step_m * i};
      ribbon.T_world_body.push_back(pose);
    }
    SceneTriangles solid(front_view()), translucent(front_view());
    add_ribbon(ribbon, 1.0, solid, translucent);
    Eigen::AlignedBox3d box;
    for (const SceneVertex& v : solid.vertices()) box.extend(place(v));
    if (poses > 1) {
      EXPECT_LT((box.min() - Eigen::Vector3d(-4.0, 3.0, 20.0)).norm(), 1e-4);
      EXPECT_LT((box.max() - Eigen::Vector3d(4.0, 3.0, 20.0 + step_m * (poses - 1))).norm(), 1e-4);
    }
    // Two triangles a piece, and as many on either edge.
    EXPECT_EQ(solid.vertices().size(), 2 * translucent.vertices().size());
    return translucent.vertices().size();
  };
  EXPECT_EQ(vertices(1, 1.0), 0U);
  EXPECT_EQ(vertices(6, 10.0), 5U * 6U);
  EXPECT_LT(vertices(5001, 0.01), 200U * 6U);
  EXPECT_GE(vertices(5001, 0.01), 50U * 6U);
}

const PinholeCamera kSeenCamera{100, 80, 50.0, 50.0, 49.5, 39.5};

TEST(FrustumMesh, ReachesTheGroundAtTheImagesCorners) {
  const FlatGround ground(0.0);
  SceneContent::Frustum frustum;
  frustum.camera = kSeenCamera;
  frustum.T_world_camera = {R_world_body_from({}) * R_body_camera_nadir(), {10.0, 20.0, 100.0}};
  // From 1000 m above, so that the footprint of 200 x 160 m is in view.
  const Pose above{R_world_body_from({}) * R_body_camera_nadir(), {10.0, 20.0, 1000.0}};
  const View view = View::from(kSceneCamera, above);
  const auto box_of = [&](bool footprint) {
    frustum.footprint = footprint;
    SceneTriangles triangles(view);
    add_frustum(frustum, ground, triangles);
    return std::pair{pixel_box(triangles), triangles.vertices().size()};
  };
  const auto [box, count] = box_of(true);
  // 0.25 px per metre; lines are up to 2.4 px wide.
  EXPECT_NEAR(box.sizes().x(), 50.0, 3.0);
  EXPECT_NEAR(box.sizes().y(), 40.0, 3.0);
  EXPECT_LT((box.center() - Eigen::Vector2d(199.5, 149.5)).norm(), 0.2);
  // Four edges of six vertices, four faces of three, and 64 pieces of the outline.
  EXPECT_EQ(box_of(false).second, 4U * 6U + 4U * 3U);
  EXPECT_EQ(count, 4U * 6U + 4U * 3U + 64U * 6U);
}

TEST(FrustumMesh, FollowsTheBorderOfALens) {
  const FlatGround ground(0.0);
  SceneContent::Frustum frustum;
  frustum.camera = CameraModel(kSeenCamera, {DistortionModel::kRadtan, {-0.1, 0.01, 0, 0, 0}});
  ASSERT_TRUE(frustum.camera.validate().ok());
  frustum.T_world_camera = {R_world_body_from({}) * R_body_camera_nadir(), {10.0, 20.0, 100.0}};
  const Pose above{R_world_body_from({}) * R_body_camera_nadir(), {10.0, 20.0, 1000.0}};
  frustum.edges = false;
  SceneTriangles outline(View::from(kSceneCamera, above));
  add_frustum(frustum, ground, outline);
  EXPECT_EQ(outline.vertices().size(), 64U * 6U);
  for (const SceneVertex& v : outline.vertices()) {
    // Both cameras look straight down from the same place on the map.
    const Eigen::Vector3d ray = kSceneCamera.ray(pixel_of(v));
    const auto seen = frustum.camera.project({1000.0 * ray.x(), 1000.0 * ray.y(), 100.0});
    ASSERT_TRUE(seen);
    const Eigen::Vector2d from_middle = (*seen - Eigen::Vector2d(49.5, 39.5)).cwiseAbs();
    const double off_px = (from_middle - Eigen::Vector2d(50.0, 40.0)).maxCoeff();
    // Half of the line's width is 1.2 px of the view, 4.8 m on the ground.
    EXPECT_NEAR(off_px, 0.0, 50.0 * 4.8 / 100.0);
  }
  frustum.edges = true;
  frustum.footprint = false;
  SceneTriangles pyramid(View::from(kSceneCamera, above));
  add_frustum(frustum, ground, pyramid);
  EXPECT_EQ(pyramid.vertices().size(), 4U * 6U + 64U * 3U) << "the faces are curved";
}

TEST(FrustumMesh, LeavesOutPixelsWithoutARay) {
  SceneContent::Frustum frustum;
  // Folds before the image's corners.
  frustum.camera = CameraModel(kSeenCamera, {DistortionModel::kRadtan, {-0.15, 0, 0, 0, 0}});
  ASSERT_FALSE(frustum.camera.ray({-0.5, -0.5}));
  frustum.T_world_camera = {R_world_body_from({}) * R_body_camera_nadir(), {10.0, 20.0, 100.0}};
  const Pose above{R_world_body_from({}) * R_body_camera_nadir(), {10.0, 20.0, 1000.0}};
  SceneTriangles triangles(View::from(kSceneCamera, above));
  add_frustum(frustum, FlatGround(0.0), triangles);
  EXPECT_FALSE(triangles.vertices().empty());
  EXPECT_LT(triangles.vertices().size(), 64U * 3U + 64U * 6U);
  for (const SceneVertex& v : triangles.vertices()) EXPECT_TRUE(place(v).allFinite());
}

}  // namespace
}  // namespace overfly::renderer
