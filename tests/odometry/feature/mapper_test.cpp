#include "odometry/feature/map/mapper.hpp"

#include <gtest/gtest.h>

#include "odometry/feature/start/initialiser.hpp"
#include "tests/odometry/level_scene.hpp"

namespace overfly::odometry::feature {
namespace {

using testing::LevelScene;

/// A map of one keyframe over flat ground 1 away, which sees ten points.
Map one_keyframe() {
  Map map;
  Keyframe made;
  made.frame = 100;
  Keyframe& keyframe = map.add_keyframe(std::move(made));
  for (int i = 0; i < 10; ++i) {
    const int id = map.add_point({}).id;
    map.add_observation(keyframe, {id, {10.0 * i, 5.0}, 0.2});
  }
  return map;
}

TrackResult sees(int points, const Pose& T_camera_vo = {}) {
  TrackResult tracked;
  tracked.tracked = true;
  tracked.T_camera_vo = T_camera_vo;
  tracked.points.resize(static_cast<std::size_t>(points));
  return tracked;
}

TEST(Mapper, WantsAKeyframeWhenTheViewTurnsMovesOrLosesPoints) {
  const Mapper mapper({320, 240, 175.0, 175.0, 159.5, 119.5}, {});
  const Map map = one_keyframe();
  FrameImage later;
  later.index = 110;
  EXPECT_FALSE(mapper.wants_keyframe(later, sees(10), map));
  // 8 deg is 0.14 rad.
  const Pose turned{Eigen::Quaterniond(exp_so3({0.0, 0.0, 0.15})), {0, 0, 0}};
  const Pose turned_less{Eigen::Quaterniond(exp_so3({0.0, 0.0, 0.13})), {0, 0, 0}};
  EXPECT_TRUE(mapper.wants_keyframe(later, sees(10, turned), map));
  EXPECT_FALSE(mapper.wants_keyframe(later, sees(10, turned_less), map));
  // A twentieth of the depth.
  EXPECT_TRUE(mapper.wants_keyframe(later, sees(10, Pose{{1, 0, 0, 0}, {0, 0.051, 0}}), map));
  EXPECT_FALSE(mapper.wants_keyframe(later, sees(10, Pose{{1, 0, 0, 0}, {0, 0.049, 0}}), map));
  EXPECT_TRUE(mapper.wants_keyframe(later, sees(6), map));
  EXPECT_FALSE(mapper.wants_keyframe(later, sees(7), map));
  // Not at once after the last.
  later.index = 102;
  EXPECT_FALSE(mapper.wants_keyframe(later, sees(6, turned), map));
}

/// A first map, and a frame after it as it was tracked.
class MapperOverGround : public ::testing::Test {
 protected:
  void SetUp() override {
    Initialiser initialiser(scene_.camera(), {});
    std::size_t i = 0;
    while (!initialiser.process(scene_.frame(i), orb_, map_)) ++i;
    mapper_.add_candidates(orb_, map_);
    frame_ = scene_.frame(i + 4);
    tracked_ =
        Tracker(scene_.camera(), {}).track(frame_.pyramid, map_.newest().T_camera_vo, 3, map_);
    ASSERT_TRUE(tracked_.tracked);
  }

  LevelScene scene_;
  OrbExtractor orb_{FeatureParameters{}};
  Mapper mapper_{scene_.camera(), {}};
  Map map_;
  FrameImage frame_;
  TrackResult tracked_;
  std::map<std::string, double> timing_ms_;
};

TEST_F(MapperOverGround, FindsNewPointsNearTheGround) {
  const std::size_t before = map_.points().size();
  int newest_before = 0;
  for (const MapPoint& point : map_.points()) newest_before = point.id;
  mapper_.extend(frame_, tracked_, map_, timing_ms_);
  EXPECT_GT(map_.points().size(), before + 20);
  for (const MapPoint& point : map_.points()) {
    if (point.id <= newest_before) continue;
    // 200 m of height is 1; the relief is 5 m.
    EXPECT_NEAR(point.position_vo.z(), 1.0, 0.06) << point.id;
    EXPECT_GE(point.keyframes.size(), 2U);
  }
}

TEST_F(MapperOverGround, DropsPointsThatAreSeldomWhereTheyShouldBe) {
  mapper_.extend(frame_, tracked_, map_, timing_ms_);
  auto point = map_.points().begin();
  const int seldom = point->id;
  point->expected = 20;
  point->found = 4;
  const int often = (++point)->id;
  point->expected = 20;
  point->found = 6;
  const int young = (++point)->id;
  point->expected = 8;
  point->found = 0;
  mapper_.refine(orb_, map_, timing_ms_);
  EXPECT_EQ(map_.point(seldom), nullptr);
  EXPECT_NE(map_.point(often), nullptr);
  EXPECT_NE(map_.point(young), nullptr);
}

TEST_F(MapperOverGround, LocalAdjustmentMendsADisturbedKeyframeAndRemovesAWrongSight) {
  mapper_.extend(frame_, tracked_, map_, timing_ms_);
  const Pose origin = map_.keyframes().begin()->second.T_camera_vo;
  const Pose before = map_.newest().T_camera_vo;
  Keyframe& newest = map_.newest();
  newest.T_camera_vo.translation += Eigen::Vector3d(0.004, -0.003, 0.002);
  Observation& wrong = newest.observations[5];
  const int point = wrong.point;
  wrong.pixel.x() += 12.0;
  const std::size_t sights = newest.observations.size();
  adjust_locally(scene_.camera(), {}, map_);
  EXPECT_LT((map_.newest().T_camera_vo.translation - before.translation).norm(), 5e-4);
  EXPECT_EQ(map_.keyframes().begin()->second.T_camera_vo.translation, origin.translation);
  EXPECT_LT(map_.newest().observations.size(), sights);
  for (const Observation& seen : map_.newest().observations) EXPECT_NE(seen.point, point);
}

}  // namespace
}  // namespace overfly::odometry::feature
