#include "odometry/feature/map/relocaliser.hpp"

#include <gtest/gtest.h>

#include "odometry/feature/map/map_keeper.hpp"
#include "odometry/feature/start/initialiser.hpp"
#include "tests/odometry/level_scene.hpp"

namespace overfly::odometry::feature {
namespace {

using testing::LevelScene;
using testing::SyntheticGround;

/// The first map of a level flight.
class LostCamera : public ::testing::Test {
 protected:
  void SetUp() override {
    Initialiser initialiser(scene_.camera(), {});
    std::size_t i = 0;
    while (i < scene_.T_world_camera().size() &&
           !initialiser.process(scene_.frame(i), orb_, map_)) {
      ++i;
    }
    ASSERT_FALSE(map_.keyframes().empty());
    seen_ = i;
  }

  [[nodiscard]] Relocalisation found(const FrameImage& frame) {
    return relocalise(scene_.camera(), {}, frame.pyramid.level(0), orb_, map_);
  }

  void expect_found(const Pose& T_world_camera, double most_rad, double most_m) {
    const Relocalisation result = found(scene_.frame(seen_ + 1, T_world_camera));
    EXPECT_GE(result.matches, 25);
    ASSERT_TRUE(result.T_camera_vo);
    const Pose& T_world_first =
        scene_.T_world_camera()[static_cast<std::size_t>(map_.keyframes().begin()->second.frame)];
    const Pose truth = (T_world_first.inverse() * T_world_camera).inverse();
    EXPECT_LT(rotation_angle_rad(result.T_camera_vo->rotation, truth.rotation), most_rad);
    // The ground on the first view's axis is 1 away: 200 m but for the relief.
    EXPECT_LT((200.0 * result.T_camera_vo->translation - truth.translation).norm(), most_m);
  }

  LevelScene scene_;
  OrbExtractor orb_{FeatureParameters{}};
  Map map_;
  std::size_t seen_ = 0;  ///< the frame that completed the map
};

TEST_F(LostCamera, IsFoundTurnedAndMoved) {
  Pose T_world_camera = scene_.T_world_camera()[seen_];
  T_world_camera.translation += Eigen::Vector3d(6.0, -4.0, 5.0);
  T_world_camera.rotation = T_world_camera.rotation * exp_so3({0.05, -0.08, 0.6});
  expect_found(T_world_camera, rad_from_deg(0.5), 2.0);
}

TEST_F(LostCamera, IsFoundBankedToAnySide) {
  const std::vector<Eigen::Vector3d> axes{
      {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {-1.0, 0.0, 0.0}, {0.0, -1.0, 0.0}, {0.6, 0.8, 0.0}};
  for (const Eigen::Vector3d& axis : axes) {
    SCOPED_TRACE(axis.transpose());
    Pose T_world_camera = scene_.T_world_camera()[seen_];
    T_world_camera.rotation = T_world_camera.rotation * exp_so3(rad_from_deg(45.0) * axis);
    // Few points, all to one side of the image: 0.65 deg and 2.5 m were the worst seen.
    expect_found(T_world_camera, rad_from_deg(1.5), 5.0);
  }
}

TEST_F(LostCamera, IsNotFoundOverOtherGround) {
  const SyntheticGround other = SyntheticGround::procedural(9, 512, 1.0, 5.0);
  const auto image = std::make_shared<const Image>(
      other.render(scene_.camera(), scene_.T_world_camera()[seen_], 1.0, 1));
  const FrameImage frame{0, 0, build_pyramid(image)};
  EXPECT_TRUE(shows_something(frame.pyramid));
  const Relocalisation result = found(frame);
  EXPECT_FALSE(result.T_camera_vo);
}

}  // namespace
}  // namespace overfly::odometry::feature
