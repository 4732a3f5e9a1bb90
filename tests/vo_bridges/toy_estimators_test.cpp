#include "vo_bridges/toy/toy_estimators.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "core/motion/trajectory.hpp"
#include "evaluation/evaluation.hpp"
#include "tests/vo_bridges/vo_port_contract.hpp"

namespace overfly {
namespace {

using ::testing::HasSubstr;
using testing::plain_frames;
using testing::VoPortCase;
using testing::VoPortContract;

/// A helix of a nadir camera in the world frame: 40 s, 25 m/s, climbing, turning.
Pose helix(double t_s) {
  const double angle_rad = 0.1 * t_s;
  const Eigen::Vector3d p(250.0 * std::sin(angle_rad), 250.0 * std::cos(angle_rad), 300.0 + t_s);
  const RollPitchYaw attitude{0.3 * std::sin(t_s), 0.05, angle_rad};
  return Pose{R_world_body_from(attitude), p} *
         Pose{R_body_camera_nadir(), Eigen::Vector3d::Zero()};
}

constexpr int kFrames = 1240;

Trajectory truth() {
  Trajectory trajectory;
  for (int i = 0; i < kFrames; ++i) {
    const std::int64_t t_ns = frame_time_ns(i, FrameRate{});
    EXPECT_TRUE(trajectory.append({t_ns, helix(s_from_ns(t_ns))}).ok());
  }
  return trajectory;
}

/// The trajectory's poses, each with one true depth.
ToyTruthAt flown(const Trajectory& T_world_camera, std::optional<double> depth_m = {}) {
  return [=](std::int64_t t_ns) -> std::optional<ToyTruth> {
    const std::optional<Pose> pose = T_world_camera.at(t_ns);
    if (!pose) return std::nullopt;
    return ToyTruth{*pose, depth_m};
  };
}

EstimateTrack fly(VoPort& estimator) {
  EstimateTrack track;
  for (const VoFrame& frame : plain_frames(kFrames, 16, 12)) {
    track.samples.push_back(estimator.track(frame).value().sample);
  }
  return track;
}

INSTANTIATE_TEST_SUITE_P(
    Toys,
    VoPortContract,
    ::testing::Values(
        VoPortCase{"perfect",
                   [] { return create_perfect_estimator(flown(truth()), {}).value(); },
                   [] { return plain_frames(8); },
                   8},
        VoPortCase{"drifting",
                   [] {
                     return create_drifting_estimator(flown(truth()), {0.5, 0.01, 300.0}).value();
                   },
                   [] { return plain_frames(8); },
                   8}),
    [](const auto& instance) { return instance.param.name; });

TEST(ToyEstimators, PerfectScoresZeroInEveryAlignmentThatFindsTheScale) {
  const auto estimator = create_perfect_estimator(flown(truth(), 280.0), {}).value();
  evaluation::Options options;
  options.init_true_depth_m = 280.0;
  const evaluation::Score score = evaluation::score(truth(), fly(*estimator), options);
  EXPECT_EQ(score.outcome, evaluation::Outcome::kCompleted);
  EXPECT_EQ(score.coverage, 1.0);
  for (const auto mode : {evaluation::AlignmentMode::kInitScale,
                          evaluation::AlignmentMode::kSim3,
                          evaluation::AlignmentMode::kOriginSim3}) {
    const evaluation::AlignmentScore& aligned = score.alignments.at(mode);
    EXPECT_NEAR(aligned.S_world_vo.scale, 1.0 / 0.37, 1e-9) << to_string(mode);
    EXPECT_LT(aligned.position_m.max, 1e-9) << to_string(mode);
    EXPECT_LT(aligned.position_rmse_hold_m, 1e-9);
    EXPECT_LT(aligned.rotation_deg->max, 1e-9);
    EXPECT_LT(aligned.rotation_euler_norm_deg->max, 1e-9);
    for (const evaluation::RelativeError& relative : aligned.relative) {
      EXPECT_LT(relative.translation_percent, 1e-9);
    }
  }
}

/// Without the scale, the error at p is (1 - 0.37) |p - p0|: its RMS is known.
TEST(ToyEstimators, PerfectInAnUnknownScaleScoresTheMissingPart) {
  const auto estimator = create_perfect_estimator(flown(truth()), {0.37, 0.0, 0.0}).value();
  const evaluation::Score score = evaluation::score(truth(), fly(*estimator), {});
  double sum_m2 = 0.0;
  for (int i = 0; i < kFrames; ++i) {
    const double t_s = s_from_ns(frame_time_ns(i, FrameRate{}));
    sum_m2 += (helix(t_s).translation - helix(0.0).translation).squaredNorm();
  }
  EXPECT_NEAR(score.alignments.at(evaluation::AlignmentMode::kOrigin).position_m.rmse,
              0.63 * std::sqrt(sum_m2 / kFrames),
              1e-9);
}

/// On the helix |p - p0|^2 = (2 r sin(a/2))^2 + t^2, a = 0.1 t: with a known scale, the drifting
/// estimator is off by 1 % of it, and its relative error is 1 % of the chord of each length.
TEST(ToyEstimators, DriftingScoresItsClosedForm) {
  const auto estimator = create_drifting_estimator(flown(truth()), {0.37, 0.01, 280.0}).value();
  evaluation::Options options;
  options.init_true_depth_m = 280.0;
  options.rpe_lengths_m = {100.0};
  const evaluation::Score score = evaluation::score(truth(), fly(*estimator), options);
  double sum_m2 = 0.0;
  double largest_m = 0.0;
  for (int i = 0; i < kFrames; ++i) {
    const double t_s = s_from_ns(frame_time_ns(i, FrameRate{}));
    const double chord_m = 500.0 * std::sin(0.05 * t_s);
    sum_m2 += chord_m * chord_m + t_s * t_s;
    largest_m = std::max(largest_m, std::hypot(chord_m, t_s));
  }
  const auto& init = score.alignments.at(evaluation::AlignmentMode::kInitScale);
  EXPECT_TRUE(init.notes.empty());
  EXPECT_NEAR(init.position_m.rmse, 0.01 * std::sqrt(sum_m2 / kFrames), 1e-9);
  EXPECT_NEAR(init.position_m.max, 0.01 * largest_m, 1e-9);
  EXPECT_LT(init.rotation_deg->max, 1e-9);

  // Each 100 m piece spans the first whole number of frames beyond 100 m of way along the truth;
  // way and chord per frame are those of the helix sampled at 31 Hz.
  const double frame_s = 1.0 / 31.0;
  const double step_m = std::hypot(500.0 * std::sin(0.05 * frame_s), frame_s);
  const double piece_s = (std::floor(100.0 / step_m) + 1.0) * frame_s;
  const double piece_chord_m = std::hypot(500.0 * std::sin(0.05 * piece_s), piece_s);
  ASSERT_EQ(init.relative.size(), 1U);
  // Stamps are whole nanoseconds, which shifts positions by up to 1e-8 m.
  EXPECT_NEAR(init.relative[0].translation_percent, 0.01 * piece_chord_m, 1e-8);
  EXPECT_NEAR(init.relative[0].translation_mean_percent, 0.01 * piece_chord_m, 1e-8);

  // A constant factor is a scale: sim3 and the path ratio take it away.
  EXPECT_LT(score.alignments.at(evaluation::AlignmentMode::kSim3).position_m.max, 1e-9);
  const auto again = create_drifting_estimator(flown(truth()), {0.37, 0.01, 0.0}).value();
  const evaluation::Score no_depth = evaluation::score(truth(), fly(*again), {});
  const auto& path = no_depth.alignments.at(evaluation::AlignmentMode::kInitScale);
  EXPECT_LT(path.position_m.max, 1e-9);
  ASSERT_EQ(path.notes.size(), 1U);
  EXPECT_THAT(path.notes[0], HasSubstr("path of the first 5 s"));
}

TEST(ToyEstimators, LosesTrackWhereTheTruthEnds) {
  Trajectory half;
  const Trajectory whole = truth();
  for (const StampedPose& stamped : whole.poses()) {
    if (stamped.t_ns <= 20 * kNsPerS) {
      ASSERT_TRUE(half.append(stamped).ok());
    }
  }
  const auto estimator = create_perfect_estimator(flown(half), {}).value();
  const evaluation::Score score = evaluation::score(whole, fly(*estimator), {});
  EXPECT_EQ(score.outcome, evaluation::Outcome::kLost);
  // Frame 620 is stamped 20 s; the one after it has no truth.
  EXPECT_EQ(*score.outcome_time_s, s_from_ns(frame_time_ns(621, FrameRate{})));
}

TEST(ToyEstimators, RefuseParametersOutsideTheirLimits) {
  EXPECT_THAT(create_perfect_estimator(flown(truth()), {0.0, 0.0, 0.0}).error().message,
              HasSubstr("scale = 0"));
  EXPECT_THAT(create_drifting_estimator(flown(truth()), {1.0, -1.0, 0.0}).error().message,
              HasSubstr("drift = -1"));
  EXPECT_THAT(create_drifting_estimator(flown(truth()), {1.0, 0.0, -5.0}).error().message,
              HasSubstr("scene_depth_m = -5"));
}

}  // namespace
}  // namespace overfly
