// What a camera sees, against closed forms over level ground.
#include "server/missions/camera_view.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/server/missions/level_world.hpp"

namespace overfly::server {
namespace {

constexpr double kFocalPx = 500.0;
constexpr double kHeightM = 200.0;

CameraModel camera_640() {
  return CameraModel(PinholeCamera{640, 480, kFocalPx, kFocalPx, 319.5, 239.5});
}

/// A nadir camera over the ground, of a level aircraft.
Pose nadir_at(const terrain::TileSource& tiles, double east_m, double north_m, double yaw_rad = 0) {
  const double up_m = tiles.ground_up_m(east_m, north_m) + kHeightM;
  return Pose{R_world_body_from({0.0, 0.0, yaw_rad}), {east_m, north_m, up_m}} *
         Pose{R_body_camera_nadir(), Eigen::Vector3d::Zero()};
}

class CameraViewTest : public ::testing::Test {
 protected:
  testing::LevelWorld world_;
  const terrain::TileSource& tiles_ = *world_.world().tiles;
  const CameraModel camera_ = camera_640();
};

TEST_F(CameraViewTest, CountsTexelsByTheGroundDistanceOfAPixel) {
  const CameraView view = view_of(camera_, nadir_at(tiles_, 0, 0), tiles_);
  const double expected = kHeightM / kFocalPx / testing::LevelWorld::kTexelM;
  EXPECT_NEAR(texels_per_pixel(camera_, view, testing::LevelWorld::kTexelM).value(),
              expected,
              1e-3 * expected);
  EXPECT_EQ(imagery_share(view, tiles_), 1.0);
}

TEST_F(CameraViewTest, SeesItsFootprint) {
  const auto quad = footprint_of(camera_, nadir_at(tiles_, 0, 0), tiles_);
  ASSERT_TRUE(quad.has_value());
  // Upper left: forward is north, left is west; 640 x 480 px of 0.4 m.
  EXPECT_NEAR((*quad)[0].x(), -128.0, 0.05);
  EXPECT_NEAR((*quad)[0].y(), 96.0, 0.05);
  EXPECT_NEAR((*quad)[2].x(), 128.0, 0.05);
  EXPECT_NEAR((*quad)[2].y(), -96.0, 0.05);
}

TEST_F(CameraViewTest, OverlapsByTheSharedArea) {
  const auto here = footprint_of(camera_, nadir_at(tiles_, 0, 0), tiles_).value();
  const auto ahead = footprint_of(camera_, nadir_at(tiles_, 0, 48), tiles_).value();
  const auto beside = footprint_of(camera_, nadir_at(tiles_, 64, 48), tiles_).value();
  const auto far = footprint_of(camera_, nadir_at(tiles_, 0, 200), tiles_).value();
  const auto turned = footprint_of(camera_, nadir_at(tiles_, 0, 0, kPi / 2.0), tiles_).value();
  EXPECT_NEAR(overlap_of(here, here), 1.0, 1e-9);
  EXPECT_NEAR(overlap_of(here, ahead), 0.75, 1e-3);
  EXPECT_NEAR(overlap_of(here, beside), 0.75 * 0.75, 1e-3);
  EXPECT_EQ(overlap_of(here, far), 0.0);
  EXPECT_NEAR(overlap_of(here, turned), 0.75, 1e-3);  // 192 of 256 m
}

TEST_F(CameraViewTest, MovesPixelsByTranslationAndRotation) {
  const CameraView view = view_of(camera_, nadir_at(tiles_, 0, 0), tiles_);
  const PixelMotion ahead = motion_of(camera_, view, nadir_at(tiles_, 0, 1.0));
  EXPECT_NEAR(ahead.translation_px, kFocalPx * 1.0 / kHeightM, 1e-3);
  EXPECT_NEAR(ahead.rotation_px, 0.0, 1e-9);
  const double angle = 0.01;
  const PixelMotion turn = motion_of(camera_, view, nadir_at(tiles_, 0, 0, angle));
  // Of a turn about the axis: the radius times the angle; columns at 0, +-128 and +-256 px, rows
  // at 0, +-96 and +-192 px.
  const double square = 0.4 * (128.0 * 128.0 + 256.0 * 256.0) + 0.4 * (96.0 * 96.0 + 192.0 * 192.0);
  EXPECT_NEAR(turn.rotation_px, angle * std::sqrt(square), 1e-2);
  EXPECT_NEAR(turn.translation_px, 0.0, 1e-6);
  Pose rolled = nadir_at(tiles_, 0, 0);
  rolled.rotation = R_world_body_from({angle, 0.0, 0.0}) * R_body_camera_nadir();
  // At least f times the angle, more towards the image's sides.
  EXPECT_GT(motion_of(camera_, view, rolled).rotation_px, kFocalPx * angle);
  EXPECT_LT(motion_of(camera_, view, rolled).rotation_px, 1.4 * kFocalPx * angle);
}

TEST_F(CameraViewTest, SeesNoGroundInTheSky) {
  Pose ahead = nadir_at(tiles_, 0, 0);
  ahead.rotation = R_world_body_from({0.0, kPi / 2.0, 0.0}) * R_body_camera_nadir();
  const CameraView view = view_of(camera_, ahead, tiles_);  // upwards half of the image
  EXPECT_FALSE(footprint_of(camera_, ahead, tiles_).has_value());
  EXPECT_LT(imagery_share(view, tiles_), 0.5);
}

}  // namespace
}  // namespace overfly::server
