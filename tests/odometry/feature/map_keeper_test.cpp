// Mapping on its own thread gives the same map as mapping before the answer.
#include "odometry/feature/map/map_keeper.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include "odometry/feature/start/initialiser.hpp"
#include "tests/odometry/level_scene.hpp"

namespace overfly::odometry::feature {
namespace {

struct Followed {
  std::vector<Pose> poses;  ///< T_camera_vo as tracked
  int keyframes = 0;
  std::size_t points = 0;
  std::size_t memory_bytes = 0;  ///< of the keeper
  std::size_t view_bytes = 0;    ///< of the map that it shows
  std::size_t image_bytes = 0;
};

/// Follows a level flight; with two threads it waits for each keyframe's mapping.
Followed follow(int threads) {
  const testing::LevelScene scene;
  const PinholeCamera& camera = scene.camera();
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
  for (std::size_t i = 0; i < scene.T_world_camera().size(); ++i) {
    const FrameImage frame = scene.frame(i);
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
  EXPECT_EQ(keeper.take_cpu_s() > 0.0, threads > 1);
  const Map& map = keeper.refresh();
  followed.keyframes = map.newest().id + 1;
  followed.points = map.points().size();
  followed.memory_bytes = keeper.memory_bytes();
  followed.view_bytes = map.memory_bytes();
  followed.image_bytes = map.image_bytes();
  return followed;
}

TEST(MapKeeper, MapsTheSameBesideTrackingAsBeforeTheAnswer) {
  const Followed before = follow(1);
  const Followed on_thread = follow(2);
  ASSERT_GT(before.poses.size(), 10U);
  EXPECT_GT(before.keyframes, 3);
  EXPECT_EQ(before.keyframes, on_thread.keyframes);
  EXPECT_EQ(before.points, on_thread.points);
  ASSERT_EQ(before.poses.size(), on_thread.poses.size());
  for (std::size_t i = 0; i < before.poses.size(); ++i) {
    EXPECT_EQ(before.poses[i].translation, on_thread.poses[i].translation) << i;
    EXPECT_EQ(before.poses[i].rotation.coeffs(), on_thread.poses[i].rotation.coeffs()) << i;
  }
  // The copy for tracking shares the images.
  EXPECT_EQ(before.memory_bytes, before.view_bytes);
  EXPECT_EQ(before.image_bytes, on_thread.image_bytes);
  EXPECT_EQ(on_thread.memory_bytes,
            before.memory_bytes + on_thread.view_bytes - on_thread.image_bytes);
}

/// Tracks nothing, but has a first map and a keyframe to process.
class MapKeeperAtWork : public ::testing::Test {
 protected:
  MapKeeperAtWork() {
    for (std::size_t i = 0; i < scene_.T_world_camera().size(); ++i) {
      frames_.push_back(scene_.frame(i));
    }
  }
  static FeatureParameters parameters() {
    FeatureParameters parameters;
    parameters.features = 600;
    parameters.threads = 2;
    return parameters;
  }
  /// @return the frame after the one that completed the first map
  std::size_t begin() {
    Initialiser initialiser(scene_.camera(), {});
    std::size_t i = 0;
    while (!initialiser.process(frames_.at(i), orb_, keeper_.empty_map())) ++i;
    keeper_.begin();
    return i + 1;
  }

  testing::LevelScene scene_;
  std::vector<FrameImage> frames_;
  OrbExtractor orb_{parameters()};
  MapKeeper keeper_{scene_.camera(), {}, parameters()};
  Tracker tracker_{scene_.camera(), {}};
  std::map<std::string, double> timing_ms_;
};

TEST_F(MapKeeperAtWork, ForgetsAtAnyMoment) {
  for (int round = 0; round < 6; ++round) {
    const std::size_t next = begin();
    const Map& map = keeper_.refresh();
    ASSERT_GE(map.keyframes().size(), 2U);
    const TrackResult tracked =
        tracker_.track(frames_[next].pyramid, map.newest().T_camera_vo, 3, map);
    ASSERT_TRUE(tracked.tracked);
    keeper_.insert_keyframe(frames_[next], tracked, timing_ms_);
    // From before the thread wakes to after it is done.
    std::this_thread::sleep_for(std::chrono::milliseconds(4 * round));
    keeper_.clear();
    EXPECT_TRUE(keeper_.refresh().keyframes().empty());
    EXPECT_TRUE(keeper_.empty_map().keyframes().empty());
  }
}

TEST_F(MapKeeperAtWork, TellsTheTrackingThreadWhatItsThreadHasThrown) {
  const std::size_t next = begin();
  // Its points claim to be seen from a keyframe that never was.
  for (MapPoint& point : keeper_.empty_map().points()) point.keyframes.push_back(1000);
  const Map& map = keeper_.refresh();
  const TrackResult tracked =
      tracker_.track(frames_[next].pyramid, map.newest().T_camera_vo, 3, map);
  keeper_.insert_keyframe(frames_[next], tracked, timing_ms_);
  keeper_.wait_until_idle();
  EXPECT_THROW(keeper_.refresh(), std::out_of_range);
  // The exception is reported once, and the thread still runs.
  keeper_.clear();
  EXPECT_GT(begin(), 0U);
  EXPECT_FALSE(keeper_.refresh().keyframes().empty());
}

}  // namespace
}  // namespace overfly::odometry::feature
