// Mapping beside tracking does the same work as mapping before the answer.
#include "odometry/feature/map_keeper.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "core/time.hpp"
#include "synthetic_flight.hpp"

namespace overfly::odometry {
namespace {

struct Followed {
  std::vector<Pose> poses;  ///< T_camera_vo as tracked
  int keyframes = 0;
  std::size_t points = 0;
};

/// Follows a level flight; with two threads it waits for each keyframe's mapping.
Followed follow(int threads) {
  const auto camera =
      PinholeCamera::from_fov(320, 240, rad_from_deg(84.872), FovAxis::kHorizontal).value();
  const auto ground = testing::SyntheticGround::procedural(1, 512, 1.0, 5.0);
  testing::SyntheticFlightOptions flight;
  flight.speed_m_s = 40.0;
  flight.height_m = 200.0;
  flight.duration_s = 1.6;
  FeatureParameters parameters;
  parameters.features = 600;
  parameters.threads = threads;
  OrbExtractor orb(parameters);
  Initialiser initialiser(camera, {});
  const Tracker tracker(camera, {});
  MapKeeper keeper(camera, {}, parameters);
  Followed followed;
  Pose T_camera_vo;
  std::map<std::string, double> timing_ms;
  const std::vector<Pose> truth = testing::fly_s_turns(flight);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const auto index = static_cast<std::int64_t>(i);
    const auto image = std::make_shared<const Image>(ground.render(camera, truth[i], 1.0, i + 1));
    const FrameImage frame{index, frame_time_ns(index, FrameRate{}), build_pyramid(image)};
    if (keeper.view().keyframes().empty()) {
      if (!initialiser.process(frame, orb, keeper.empty_map())) continue;
      keeper.begin();
      T_camera_vo = keeper.view().newest().T_camera_vo;
      continue;
    }
    const TrackResult tracked = tracker.track(frame.pyramid, T_camera_vo, 3, keeper.refresh());
    EXPECT_TRUE(tracked.tracked) << "frame " << i;
    T_camera_vo = tracked.T_camera_vo;
    followed.poses.push_back(T_camera_vo);
    keeper.note_sights(tracked);
    if (keeper.wants_keyframe(frame, tracked)) {
      keeper.insert_keyframe(frame, tracked, timing_ms);
      keeper.wait_until_idle();
    }
  }
  keeper.take_timing(timing_ms);
  EXPECT_GT(timing_ms["mapping"], 0.0);
  const Map& map = keeper.refresh();
  followed.keyframes = map.newest().id + 1;
  followed.points = map.points().size();
  return followed;
}

TEST(MapKeeper, MapsTheSameBesideTrackingAsBeforeTheAnswer) {
  const Followed before = follow(1);
  const Followed beside = follow(2);
  ASSERT_GT(before.poses.size(), 10U);
  EXPECT_GT(before.keyframes, 3);
  EXPECT_EQ(before.keyframes, beside.keyframes);
  EXPECT_EQ(before.points, beside.points);
  ASSERT_EQ(before.poses.size(), beside.poses.size());
  for (std::size_t i = 0; i < before.poses.size(); ++i) {
    EXPECT_EQ(before.poses[i].translation, beside.poses[i].translation) << i;
    EXPECT_EQ(before.poses[i].rotation.coeffs(), beside.poses[i].rotation.coeffs()) << i;
  }
}

/// A map of two keyframes without images and a plane of points, and a frame of the same view.
TEST(MapKeeper, ForgetsWhileItsThreadIsAtWork) {
  const PinholeCamera camera{320, 240, 200.0, 200.0, 159.5, 119.5};
  FeatureParameters parameters;
  parameters.threads = 2;
  MapKeeper keeper(camera, {}, parameters);
  const auto image = std::make_shared<const Image>(320, 240, 1, std::uint8_t{90});
  for (int round = 0; round < 3; ++round) {
    Map& map = keeper.empty_map();
    for (int i = 0; i < 2; ++i) {
      Keyframe keyframe;
      keyframe.frame = i;
      keyframe.pyramid = build_pyramid(image);
      map.add_keyframe(keyframe);
    }
    keeper.begin();
    EXPECT_EQ(keeper.view().keyframes().size(), 2U);
    std::map<std::string, double> timing_ms;
    keeper.insert_keyframe({9, 9, build_pyramid(image)}, {}, timing_ms);
    keeper.clear();
    EXPECT_TRUE(keeper.refresh().keyframes().empty());
    EXPECT_TRUE(keeper.empty_map().keyframes().empty());
  }
}

}  // namespace
}  // namespace overfly::odometry
