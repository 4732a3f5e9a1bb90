// Relief, motion and overlap against closed forms over level ground, and the inputs of the model.
#include "server/experiments/predict/features/view_features.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "server/experiments/predict/features/features.hpp"
#include "tests/server/missions/level_world.hpp"

namespace overfly::server::predict {
namespace {

constexpr double kViewFocalPx = 500.0;
constexpr double kViewHeightM = 200.0;

class ViewFeatures : public ::testing::Test {
 protected:
  /// A camera that looks straight down, its image's top to the north.
  [[nodiscard]] Pose nadir_at(double east_m, double north_m, double yaw_rad = 0.0) const {
    const double up_m = tiles_.ground_up_m(east_m, north_m) + kViewHeightM;
    return Pose{R_world_body_from({0.0, 0.0, yaw_rad}), {east_m, north_m, up_m}} *
           Pose{R_body_camera_nadir(), Eigen::Vector3d::Zero()};
  }
  [[nodiscard]] CameraView view() const { return view_of(camera_, nadir_at(0.0, 0.0), tiles_); }

  server::testing::LevelWorld world_;
  const terrain::TileSource& tiles_ = *world_.world().tiles;
  const CameraModel camera_{PinholeCamera{640, 480, kViewFocalPx, kViewFocalPx, 319.5, 239.5}};
};

TEST_F(ViewFeatures, LevelGroundHasNoRelief) { EXPECT_NEAR(relief_over_height(view()), 0.0, 1e-4); }

TEST_F(ViewFeatures, ReliefIsTheRangeOfHeightsOverTheHeight) {
  CameraView hilly = view();
  const double ground_m = hilly.T_world_camera.translation.z() - kViewHeightM;
  for (ViewPoint& point : hilly.points) point.ground_world->z() = ground_m;
  hilly.points.front().ground_world->z() += 30.0;
  hilly.points.back().ground_world->z() -= 20.0;
  EXPECT_NEAR(relief_over_height(hilly), 50.0 / kViewHeightM, 1e-9);
  for (ViewPoint& point : hilly.points) point.ground_world.reset();
  EXPECT_EQ(relief_over_height(hilly), 0.0);
}

TEST_F(ViewFeatures, TranslationMovesTheImageByFocalLengthOverHeight) {
  // 10 m at 200 m: 10 / 200 * 500 px, equally everywhere.
  EXPECT_NEAR(image_motion_px(camera_, view(), nadir_at(10.0, 0.0)), 25.0, 0.01);
  EXPECT_NEAR(image_motion_px(camera_, view(), nadir_at(-6.0, 8.0)), 25.0, 0.01);
  EXPECT_NEAR(image_motion_px(camera_, view(), nadir_at(0.0, 0.0)), 0.0, 1e-6);
}

TEST_F(ViewFeatures, RotationAboutTheAxisMovesAPixelByItsRadius) {
  // Centres of 5 x 5 parts: the mean square of k * 128 px, k = -2 ... 2, is 2 * 128^2.
  const double radius_px = std::sqrt(2.0 * 128.0 * 128.0 + 2.0 * 96.0 * 96.0);
  constexpr double kAngleRad = 0.01;
  EXPECT_NEAR(image_motion_px(camera_, view(), nadir_at(0.0, 0.0, kAngleRad)),
              kAngleRad * radius_px,
              1e-3 * kAngleRad * radius_px);
}

TEST_F(ViewFeatures, OverlapShrinksWithTheWay) {
  EXPECT_NEAR(overlap_with(camera_, view(), nadir_at(0.0, 0.0)), 1.0, 1e-9);
  // The image spans 192 m along the track, 256 m across it.
  EXPECT_NEAR(overlap_with(camera_, view(), nadir_at(0.0, 48.0)), 0.75, 1e-3);
  EXPECT_NEAR(overlap_with(camera_, view(), nadir_at(64.0, 0.0)), 0.75, 1e-3);
  EXPECT_NEAR(overlap_with(camera_, view(), nadir_at(64.0, 48.0)), 0.5625, 1e-3);
  EXPECT_NEAR(overlap_with(camera_, view(), nadir_at(0.0, 500.0)), 0.0, 1e-9);
}

TEST(ModelInputs, FollowFromTheFeatures) {
  Features features;
  features.texels_per_pixel = 0.25;
  features.corners_per_kpx = 2.0;
  features.image_kpx = 300.0;
  features.image_width_px = 640.0;
  features.rotation_px = 64.0;
  features.blur_px = 3.0;
  features.overlap = 0.7;
  features.self_similarity = 0.52;
  Inputs inputs = inputs_of(features);
  EXPECT_DOUBLE_EQ(inputs[0], -2.0);
  EXPECT_DOUBLE_EQ(inputs[1], std::log(601.0));
  EXPECT_DOUBLE_EQ(inputs[3], -std::log(1.02 - 0.52));
  EXPECT_DOUBLE_EQ(inputs[5], 0.1);
  EXPECT_NEAR(inputs[7], 0.09, 1e-12);
  EXPECT_DOUBLE_EQ(inputs[8], std::log(4.0));
  EXPECT_EQ(inputs[11], 0.0) << "the imagery's own light";
  features.sun_elevation_deg = 30.0;
  features.texels_per_pixel = 0.0;
  inputs = inputs_of(features);
  EXPECT_NEAR(inputs[11], 0.5, 1e-12);
  EXPECT_DOUBLE_EQ(inputs[0], -5.0) << "without imagery: the lower limit";
}

}  // namespace
}  // namespace overfly::server::predict
