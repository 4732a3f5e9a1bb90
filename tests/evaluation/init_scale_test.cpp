// The alignment of the first pose with the scale of the first frame's depth.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/evaluation/flights.hpp"

namespace overfly::evaluation {
namespace {

using ::testing::HasSubstr;

TEST(InitScale, IsTrueDepthOverSceneDepth) {
  const Trajectory truth = wavy_truth(100);
  EstimateTrack track = seen_from(truth, some_similarity());
  track.samples.front().scene_depth = 1.25;
  Options options;
  options.init_true_depth_m = 300.0;
  AlignmentRemarks remarks;
  const auto found = align(matches_of(truth, track), AlignmentMode::kInitScale, options, &remarks);
  ASSERT_TRUE(found.ok());
  EXPECT_EQ(found->scale, 240.0);
  EXPECT_TRUE(remarks.notes.empty());
  const Pose first = *found * track.samples.front().T_vo_camera;
  EXPECT_LT((first.translation - truth.poses().front().pose.translation).norm(), 1e-9);
  EXPECT_LT(rotation_angle_rad(first.rotation, truth.poses().front().pose.rotation), 1e-12);
}

/// The true depth belongs to the first tracked frame, also where the first scored pose is a later
/// one: the truth begins later, or another frame is nearer to the truth's first pose.
TEST(InitScale, TakesBothDepthsFromTheFirstTrackedFrame) {
  Options options;
  options.init_true_depth_m = 300.0;
  for (const Association association : {Association::kInterpolate, Association::kNearest}) {
    options.association = association;
    const Trajectory truth = wavy_truth(100);
    EstimateTrack track = seen_from(truth, some_similarity());
    for (EstimateSample& sample : track.samples) sample.scene_depth = 2.0;
    EstimateSample first = track.samples.front();
    first.t_ns -= 5'000'000;
    first.scene_depth = 1.25;
    track.samples.insert(track.samples.begin(), first);
    const auto matches = associate(truth, track, options);
    ASSERT_TRUE(matches.ok()) << matches.error().message;
    EXPECT_EQ(matches->front().t_ns, 0) << to_string(association);
    const auto found = align(*matches, AlignmentMode::kInitScale, options);
    ASSERT_TRUE(found.ok()) << found.error().message;
    EXPECT_EQ(found->scale, 240.0) << to_string(association);
  }
}

TEST(InitScale, WithoutADepthIsThePathRatioAndSaysSo) {
  const Trajectory truth = wavy_truth(100);
  EstimateTrack track = seen_from(truth, some_similarity());
  // Beyond the first 5 s the estimate grows: that must not count.
  for (std::size_t i = 51; i < track.samples.size(); ++i) {
    track.samples[i].T_vo_camera.translation *= 10.0;
  }
  for (const bool with_scene_depth : {false, true}) {
    if (with_scene_depth) track.samples.front().scene_depth = 1.0;
    AlignmentRemarks remarks;
    const auto found = align(matches_of(truth, track), AlignmentMode::kInitScale, {}, &remarks);
    ASSERT_TRUE(found.ok());
    EXPECT_NEAR(found->scale, some_similarity().scale, 1e-9);
    ASSERT_EQ(remarks.notes.size(), 1U);
    EXPECT_THAT(remarks.notes[0], HasSubstr("path of the first 5 s"));
    EXPECT_THAT(remarks.notes[0], HasSubstr(with_scene_depth ? "true depth" : "scene depth"));
  }
}

/// Poses of files without times count as 1 s apart: 5 of them are no 5 s.
TEST(InitScale, WithoutTimesIsThePathRatioOfFiftySteps) {
  const Trajectory truth = wavy_truth(100);
  EstimateTrack track = seen_from(truth, some_similarity());
  for (std::size_t i = 51; i < track.samples.size(); ++i) {
    track.samples[i].T_vo_camera.translation *= 10.0;
  }
  std::vector<MatchedPose> matches = matches_of(truth, track);
  for (std::size_t i = 0; i < matches.size(); ++i) {
    matches[i].t_ns = static_cast<std::int64_t>(i) * kNsPerS;
  }
  Options options;
  options.has_times = false;
  AlignmentRemarks remarks;
  const auto found = align(matches, AlignmentMode::kInitScale, options, &remarks);
  ASSERT_TRUE(found.ok());
  EXPECT_NEAR(found->scale, some_similarity().scale, 1e-9);
  EXPECT_THAT(remarks.notes.at(0), HasSubstr("the first 50 steps (times are not known)"));
}

}  // namespace
}  // namespace overfly::evaluation
