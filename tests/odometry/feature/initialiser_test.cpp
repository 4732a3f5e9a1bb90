#include "odometry/feature/start/initialiser.hpp"

#include <gtest/gtest.h>

#include "tests/odometry/level_scene.hpp"

namespace overfly::odometry::feature {
namespace {

using testing::LevelScene;

TEST(Initialiser, KeepsNoMoreViewsHoweverLongTheCameraStands) {
  const LevelScene scene(1.6);
  FeatureParameters parameters;
  parameters.features = 300;
  OrbExtractor orb(parameters);
  Initialiser initialiser(scene.camera(), {});
  Map map;
  constexpr std::size_t kStands = 260;  // frames
  bool started = false;
  FrameImage standing = scene.frame(0);
  for (std::size_t i = 0; i < kStands; ++i) {
    standing.index = static_cast<std::int64_t>(i);
    ASSERT_FALSE(initialiser.process(standing, orb, map)) << i;
  }
  for (std::size_t i = 0; i < scene.T_world_camera().size() && !started; ++i) {
    started = initialiser.process(scene.frame(kStands + i, scene.T_world_camera()[i]), orb, map);
  }
  ASSERT_TRUE(started);
  EXPECT_EQ(map.keyframes().begin()->second.frame, 0);
  // 32 and the two ends; 260 frames hold 43 of the first interval.
  EXPECT_LE(map.keyframes().size(), 34U);
  EXPECT_GE(map.keyframes().size(), 18U);
}

TEST(Initialiser, FollowsNothingInBurntAreas) {
  const LevelScene scene;
  OrbExtractor orb(FeatureParameters{});
  FrameImage frame = scene.frame(0);
  const auto burnt_tracks = [&] {
    Initialiser initialiser(scene.camera(), {});
    Map map;
    (void)initialiser.process(frame, orb, map);
    EXPECT_GT(initialiser.tracks().size(), 100U);
    return std::count_if(initialiser.tracks().begin(),
                         initialiser.tracks().end(),
                         [](const auto& track) { return track.corner.pixel.x() < 150.0; });
  };
  EXPECT_GT(burnt_tracks(), 50);
  frame.pyramid.burnt = cv::Mat::zeros(240 / kBurntCellPx, 320 / kBurntCellPx, CV_8U);
  frame.pyramid.burnt.colRange(0, 160 / kBurntCellPx).setTo(255);
  EXPECT_EQ(burnt_tracks(), 0);
}

TEST(Initialiser, WaitsForTracksInEnoughCells) {
  const LevelScene scene(1.6);
  const auto starts = [&](int min_cells) {
    OrbExtractor orb(FeatureParameters{});
    InitialiserOptions options;
    options.min_cells = min_cells;
    Initialiser initialiser(scene.camera(), options);
    Map map;
    for (std::size_t i = 0; i < scene.T_world_camera().size(); ++i) {
      FrameImage frame = scene.frame(i);
      frame.pyramid.burnt = cv::Mat::zeros(240 / kBurntCellPx, 320 / kBurntCellPx, CV_8U);
      frame.pyramid.burnt.colRange(0, 240 / kBurntCellPx).setTo(255);
      if (initialiser.process(frame, orb, map)) return true;
    }
    return false;
  };
  // The quarter that is not burnt has about 250 of the 1000 cells.
  EXPECT_TRUE(starts(60));
  EXPECT_FALSE(starts(270));
}

}  // namespace
}  // namespace overfly::odometry::feature
