#include "server/timeline/live_alignment.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "core/motion/trajectory.hpp"
#include "core/time.hpp"
#include "evaluation/evaluation.hpp"

namespace overfly::server {
namespace {

EstimateSample tracked(std::int64_t t_s, double x, std::optional<double> depth, int map_id = 0) {
  EstimateSample sample;
  sample.frame = t_s;
  sample.t_ns = t_s * kNsPerS;
  sample.state = TrackingState::kTracking;
  sample.T_vo_camera.translation.x() = x;
  sample.scene_depth = depth;
  sample.map_id = map_id;
  return sample;
}

Pose at_x(double x) { return {Eigen::Quaterniond::Identity(), {x, 0, 0}}; }

/// An alignment and the frames that it is given.
struct Aligned {
  explicit Aligned(const Pose& T_body_camera) : alignment(T_body_camera) {}

  /// The answer to a new frame of the time that the sample's number gives [s].
  std::optional<Pose> add(const EstimateSample& sample, const Pose& truth, double axis_depth_m) {
    FrameRow row;
    row.frame = sample.frame;
    row.t_ns = sample.frame * kNsPerS;
    row.T_world_camera = truth;
    row.axis_depth_m = axis_depth_m;
    frames.push_back(row);
    return alignment.add(sample, frames);
  }

  LiveAlignment alignment;
  std::vector<FrameRow> frames;
};

/// That of the score for the same frames and samples.
Similarity scored(const std::vector<FrameRow>& frames, const EstimateTrack& track) {
  Trajectory truth;
  for (const FrameRow& row : frames) {
    EXPECT_TRUE(truth.append({row.t_ns, row.T_world_camera}).ok());
  }
  evaluation::Options options;
  options.init_true_depth_m = frames.front().axis_depth_m;
  const auto matches = evaluation::associate(truth, track, options);
  EXPECT_TRUE(matches.ok()) << matches.error().message;
  const auto S_world_vo =
      evaluation::align(*matches, evaluation::AlignmentMode::kInitScale, options);
  EXPECT_TRUE(S_world_vo.ok()) << S_world_vo.error().message;
  return *S_world_vo;
}

void expect_equal(const std::optional<Similarity>& live, const Similarity& scored) {
  ASSERT_TRUE(live.has_value());
  EXPECT_NEAR(live->scale, scored.scale, 1e-9);
  EXPECT_LT((live->translation - scored.translation).norm(), 1e-9);
  EXPECT_LT(rotation_angle_rad(live->rotation, scored.rotation), 1e-7);
}

TEST(LiveAlignment, AgreesWithTheEvaluationsInitScale) {
  Pose first = at_x(100);
  first.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()));
  Aligned live(Pose{R_body_camera_nadir(), Eigen::Vector3d::Zero()});
  EstimateTrack track;
  for (int i = 0; i < 3; ++i) {
    Pose truth = first;
    truth.translation += first.rotation * Eigen::Vector3d(30.0 * i, 0, 0);
    track.samples.push_back(tracked(i, 0.1 * i, 1.0));
    EXPECT_TRUE(live.add(track.samples.back(), truth, 300.0).has_value());
  }
  expect_equal(live.alignment.S_world_vo(), scored(live.frames, track));
}

/// With and without a scene depth, and at a speed that grows.
TEST(LiveAlignment, AgreesWithTheEvaluationWhenTheClockOfTheCameraIsWrong) {
  for (const std::int64_t offset_ns : {-500'000'000, 0, 500'000'000, 1'700'000'000}) {
    for (const bool has_depth : {false, true}) {
      Aligned live{Pose{}};
      EstimateTrack track;
      for (int i = 0; i < 12; ++i) {
        EstimateSample sample = tracked(i, 3.0 * i, {});
        sample.t_ns += offset_ns;
        if (has_depth) sample.scene_depth = 30.0 + i;
        track.samples.push_back(sample);
        const auto placed = live.add(sample, at_x(20.0 * i + 2.0 * i * i), 300.0 + 5.0 * i);
        if (i == 0) {
          EXPECT_EQ(placed.has_value(), has_depth && offset_ns == 0) << offset_ns;
        }
      }
      expect_equal(live.alignment.S_world_vo(), scored(live.frames, track));
    }
  }
}

TEST(LiveAlignment, TakesTheScaleFromFiveSecondsOfPathWithoutADepth) {
  Aligned live{Pose{}};
  for (int t = 0; t < 5; ++t) {
    EXPECT_FALSE(live.add(tracked(t, 0.5 * t, {}), at_x(10.0 * t), 300.0).has_value());
  }
  const auto placed = live.add(tracked(5, 2.5, {}), at_x(50.0), 300.0);
  ASSERT_TRUE(placed.has_value());
  EXPECT_NEAR(placed->translation.x(), 50.0, 1e-9);
}

/// The score's path has no step that ends after the 5 s either.
TEST(LiveAlignment, LeavesOutTheStepThatEndsAfterFiveSeconds) {
  Aligned live{Pose{}};
  EstimateTrack track;
  for (const int t : {0, 1, 2, 3, 4, 7}) {
    track.samples.push_back(tracked(t, t < 5 ? 0.5 * t : 100.0, {}));
    EXPECT_EQ(live.add(track.samples.back(), at_x(10.0 * t), 300.0).has_value(), t == 7) << t;
  }
  EXPECT_NEAR(live.alignment.S_world_vo()->scale, 20.0, 1e-9);
  expect_equal(live.alignment.S_world_vo(), scored(live.frames, track));
}

TEST(LiveAlignment, MeasuresUntilTruthAndEstimateHaveMoved) {
  Aligned live{Pose{}};
  for (int t = 0; t < 9; ++t) {
    EXPECT_FALSE(live.add(tracked(t, 0.5 * t, {}), at_x(0.0), 300.0).has_value()) << t;
  }
  ASSERT_TRUE(live.add(tracked(9, 4.5, {}), at_x(45.0), 300.0).has_value());
  EXPECT_NEAR(live.alignment.S_world_vo()->scale, 10.0, 1e-9);
}

TEST(LiveAlignment, StartsAnewWithANewMap) {
  Aligned live{Pose{}};
  EXPECT_NEAR(live.add(tracked(0, 0, 1.0), at_x(0), 300.0)->translation.x(), 0.0, 1e-9);
  const auto placed = live.add(tracked(9, 4.0, 2.0, 1), at_x(90), 200.0);
  ASSERT_TRUE(placed.has_value());
  EXPECT_NEAR(placed->translation.x(), 90.0, 1e-9);
  EXPECT_NEAR(live.alignment.S_world_vo()->scale, 100.0, 1e-9);
}

TEST(LiveAlignment, KeepsAMapsAlignmentWhenTheEstimatorReturnsToIt) {
  Aligned live{Pose{}};
  ASSERT_TRUE(live.add(tracked(0, 0.0, 1.0), at_x(0), 300.0).has_value());
  ASSERT_TRUE(live.add(tracked(2, 0.0, 2.0, 1), at_x(60), 300.0).has_value());
  // The first map has drifted by 10 m when the estimator finds back into it.
  const auto placed = live.add(tracked(3, 0.1, 2.0), at_x(40), 300.0);
  ASSERT_TRUE(placed.has_value());
  EXPECT_NEAR(placed->translation.x(), 30.0, 1e-9);
  EXPECT_NEAR(live.alignment.S_world_vo()->scale, 300.0, 1e-9);
}

}  // namespace
}  // namespace overfly::server
