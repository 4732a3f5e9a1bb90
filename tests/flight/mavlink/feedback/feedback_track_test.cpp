#include "flight/mavlink/feedback/feedback_track.hpp"

#include <gtest/gtest.h>

#include "core/time.hpp"

namespace overfly::flight::mavlink {
namespace {

const Eigen::Vector3d kStart(10.0, -20.0, 300.0);
const Eigen::Vector3d kVelocity(20.0, 15.0, -1.0);
const Eigen::Vector3d kAcceleration(-1.5, 2.0, 0.5);

/// Frame k of a camera with 31 Hz on a parabola.
PlacedEstimate estimate_at(std::int64_t k, int map_id = 0) {
  const std::int64_t t_ns = frame_time_ns(k, {31, 1});
  const double t_s = s_from_ns(t_ns);
  Pose pose;
  pose.translation = kStart + kVelocity * t_s + 0.5 * kAcceleration * t_s * t_s;
  return {t_ns, map_id, pose};
}

PlacedEstimate lost_at(std::int64_t k) { return {frame_time_ns(k, {31, 1}), 0, std::nullopt}; }

TEST(FeedbackTrack, DifferentiatesAParabolaExactly) {
  FeedbackTrack track;
  for (std::int64_t k = 0; k < 62; ++k) {
    const auto sample = track.take(estimate_at(k));
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->v_world_m_s.has_value(), k >= 7) << k;  // 0.2 s
    if (!sample->v_world_m_s) continue;
    const Eigen::Vector3d expected = kVelocity + kAcceleration * s_from_ns(sample->t_ns);
    EXPECT_LT((*sample->v_world_m_s - expected).norm(), 1e-7) << k;
    EXPECT_EQ(sample->reset_counter, 0);
  }
}

TEST(FeedbackTrack, CountsNewMapsLossesAndJumps) {
  FeedbackTrack track;
  const auto counter = [&](const PlacedEstimate& estimate) {
    const auto sample = track.take(estimate);
    return sample ? static_cast<int>(sample->reset_counter) : -1;
  };
  // Not before the first pose: what comes first is no reset.
  EXPECT_EQ(counter(lost_at(0)), -1);
  for (std::int64_t k = 1; k < 12; ++k) EXPECT_EQ(counter(estimate_at(k)), 0);
  // Lost for two frames, and found again.
  EXPECT_EQ(counter(lost_at(12)), -1);
  EXPECT_EQ(counter(lost_at(13)), -1);
  EXPECT_EQ(counter(estimate_at(14)), 1);
  EXPECT_EQ(counter(estimate_at(15)), 1);
  // A new map, whose scale is not known at first, is one reset.
  EXPECT_EQ(counter({frame_time_ns(16, {31, 1}), 1, std::nullopt}), -1);
  for (std::int64_t k = 17; k < 40; ++k) EXPECT_EQ(counter(estimate_at(k, 1)), 2);
  // Back in the earlier map (relocalised there).
  EXPECT_EQ(counter(estimate_at(40, 0)), 3);
  // A step within the map: less than 3 m is motion, more is a jump.
  for (std::int64_t k = 41; k < 60; ++k) EXPECT_EQ(counter(estimate_at(k)), 3);
  PlacedEstimate moved = estimate_at(60);
  moved.T_world_body->translation.x() += 2.5;
  EXPECT_EQ(counter(moved), 3);
  moved = estimate_at(61);
  moved.T_world_body->translation.y() += 12.0;
  EXPECT_EQ(counter(moved), 4);
  EXPECT_EQ(track.resets(), 4U);
}

TEST(FeedbackTrack, DoesNotTakeAFastFlightForAJump) {
  FeedbackTrack track;
  for (std::int64_t k = 0; k < 31; ++k) {
    Pose pose;
    pose.translation.x() = 150.0 * s_from_ns(frame_time_ns(k, {31, 1}));  // 4.8 m a frame
    const auto sample = track.take({frame_time_ns(k, {31, 1}), 0, pose});
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->reset_counter, 0) << k;
  }
}

TEST(FeedbackTrack, StartsTheCounterAgainAfter255) {
  FeedbackTrack track;
  for (int map = 0; map <= 256; ++map) {
    const auto sample = track.take(estimate_at(map, map));
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->reset_counter, map % 256);
  }
}

TEST(FeedbackTrack, LeavesOutTimesThatDoNotIncrease) {
  FeedbackTrack track;
  EXPECT_TRUE(track.take(estimate_at(5)));
  EXPECT_FALSE(track.take(estimate_at(5)));
  EXPECT_FALSE(track.take(estimate_at(4)));
  EXPECT_TRUE(track.take(estimate_at(6)));
}

}  // namespace
}  // namespace overfly::flight::mavlink
