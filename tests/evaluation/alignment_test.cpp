#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "evaluation/umeyama.hpp"
#include "tests/evaluation/flights.hpp"

namespace overfly::evaluation {
namespace {

using ::testing::HasSubstr;

void expect_equal(const Similarity& a, const Similarity& b, double tolerance) {
  EXPECT_NEAR(a.scale / b.scale, 1.0, tolerance);
  EXPECT_LT(rotation_angle_rad(a.rotation, b.rotation), tolerance);
  EXPECT_LT((a.translation - b.translation).norm(), tolerance * 1000.0);
}

double cost_m2(const std::vector<MatchedPose>& matches, const Similarity& S_world_vo) {
  double sum_m2 = 0.0;
  for (const MatchedPose& match : matches) {
    sum_m2 += (S_world_vo * match.T_vo_camera.translation - match.T_world_camera.translation)
                  .squaredNorm();
  }
  return sum_m2;
}

TEST(Alignment, NamesGoForthAndBack) {
  EXPECT_EQ(all_alignment_modes().size(), 8U);
  for (const AlignmentMode mode : all_alignment_modes()) {
    EXPECT_EQ(alignment_mode_from(to_string(mode)), mode);
  }
  EXPECT_EQ(alignment_mode_from("umeyama"), std::nullopt);
}

TEST(Alignment, RecoversAPlantedSimilarity) {
  const Trajectory truth = wavy_truth(300);
  const Similarity planted = some_similarity();
  const auto matches = matches_of(truth, seen_from(truth, planted));
  for (const AlignmentMode mode : {AlignmentMode::kSim3, AlignmentMode::kOriginSim3}) {
    AlignmentRemarks remarks;
    const auto found = align(matches, mode, {}, &remarks);
    ASSERT_TRUE(found.ok()) << found.error().message;
    expect_equal(*found, planted, 1e-9);
    EXPECT_TRUE(remarks.notes.empty());
    EXPECT_FALSE(remarks.degenerate);
  }
}

TEST(Alignment, RecoversAPlantedRigidTransform) {
  const Trajectory truth = wavy_truth(300);
  Similarity planted = some_similarity();
  planted.scale = 1.0;
  const auto matches = matches_of(truth, seen_from(truth, planted));
  for (const AlignmentMode mode : {AlignmentMode::kSe3, AlignmentMode::kOrigin}) {
    const auto found = align(matches, mode, {});
    ASSERT_TRUE(found.ok());
    expect_equal(*found, planted, 1e-9);
  }
  planted.rotation = Eigen::AngleAxisd(2.5, Eigen::Vector3d::UnitZ());
  const auto found =
      align(matches_of(truth, seen_from(truth, planted)), AlignmentMode::kYawOnly, {});
  ASSERT_TRUE(found.ok());
  expect_equal(*found, planted, 1e-9);
}

TEST(Alignment, NoneLeavesTheEstimateAsItIs) {
  const Trajectory truth = wavy_truth(10);
  const auto found =
      align(matches_of(truth, seen_from(truth, some_similarity())), AlignmentMode::kNone, {});
  expect_equal(*found, Similarity{}, 1e-300);
}

/// Where an alignment turns and scales about: the point that its optimum maps onto its partner.
struct Hinge {
  Eigen::Vector3d vo = Eigen::Vector3d::Zero();
  Eigen::Vector3d world = Eigen::Vector3d::Zero();
};

Hinge hinge_of(const std::vector<MatchedPose>& matches, AlignmentMode mode) {
  if (mode == AlignmentMode::kOriginSim3) {
    return {matches.front().T_vo_camera.translation, matches.front().T_world_camera.translation};
  }
  Hinge mean;
  for (const MatchedPose& match : matches) {
    mean.vo += match.T_vo_camera.translation / static_cast<double>(matches.size());
    mean.world += match.T_world_camera.translation / static_cast<double>(matches.size());
  }
  return mean;
}

/// The similarities a little off in each parameter that the mode is free to choose.
std::vector<Similarity> neighbours(const Similarity& best, AlignmentMode mode, const Hinge& hinge) {
  std::vector<Similarity> all;
  const auto about_hinge = [&](Similarity S) {
    S.translation = hinge.world - S.scale * (S.rotation * hinge.vo);
    all.push_back(S);
  };
  for (const double sign : {-1.0, 1.0}) {
    for (int axis = mode == AlignmentMode::kYawOnly ? 2 : 0; axis < 3; ++axis) {
      Similarity turned = best;
      turned.rotation = Eigen::AngleAxisd(sign * 1e-4, Eigen::Vector3d::Unit(axis)) * best.rotation;
      about_hinge(turned);
    }
    if (mode == AlignmentMode::kSim3 || mode == AlignmentMode::kOriginSim3) {
      Similarity larger = best;
      larger.scale *= 1.0 + sign * 1e-4;
      about_hinge(larger);
    }
    if (mode == AlignmentMode::kOriginSim3) continue;
    for (int axis = 0; axis < 3; ++axis) {
      Similarity moved = best;
      moved.translation(axis) += sign * 1e-2;
      all.push_back(moved);
    }
  }
  return all;
}

/// With noise there is no planted answer, but at the least squares no small change of any
/// parameter lowers the cost.
TEST(Alignment, FindsTheLeastSquaresOfNoisyPositions) {
  const Trajectory truth = wavy_truth(200);
  EstimateTrack track = seen_from(truth, some_similarity());
  std::mt19937_64 random(11);
  std::normal_distribution<double> noise(0.0, 0.02);
  for (EstimateSample& sample : track.samples) {
    sample.T_vo_camera.translation += Eigen::Vector3d(noise(random), noise(random), noise(random));
  }
  const auto matches = matches_of(truth, track);
  for (const AlignmentMode mode : {AlignmentMode::kSe3,
                                   AlignmentMode::kSim3,
                                   AlignmentMode::kYawOnly,
                                   AlignmentMode::kOriginSim3}) {
    const Similarity best = align(matches, mode, {}).value();
    const Hinge hinge = hinge_of(matches, mode);
    EXPECT_LT((best * hinge.vo - hinge.world).norm(), 1e-9) << to_string(mode);
    for (const Similarity& other : neighbours(best, mode, hinge)) {
      EXPECT_GT(cost_m2(matches, other), cost_m2(matches, best)) << to_string(mode);
    }
  }
}

/// A mirrored path has no rotation onto itself: the answer must stay a rotation, and be the best.
TEST(Alignment, KeepsARotationWhereAReflectionWouldFitBetter) {
  const Trajectory truth = wavy_truth(200);
  EstimateTrack track = seen_from(truth, Similarity{});
  for (EstimateSample& sample : track.samples) {
    sample.T_vo_camera.translation.x() *= -1.0;
  }
  const auto matches = matches_of(truth, track);
  const Similarity best = align(matches, AlignmentMode::kSim3, {}).value();
  EXPECT_NEAR(best.rotation.toRotationMatrix().determinant(), 1.0, 1e-12);
  EXPECT_GT(best.scale, 0.0);
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 2000; ++i) {
    Similarity other = best;
    other.rotation =
        Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
            .normalized();
    EXPECT_GT(cost_m2(matches, other), cost_m2(matches, best));
  }
}

/// A straight leg: the rotation about it comes from the orientations.
TEST(Alignment, TakesTheRotationAboutAStraightLineFromTheOrientations) {
  Trajectory truth;
  for (int i = 0; i < 100; ++i) {
    const Pose T_world_camera = Pose{R_world_body_from({0.0, 0.0, kPi}), {0.0, -2.5 * i, 300.0}} *
                                Pose{R_body_camera_nadir(), Eigen::Vector3d::Zero()};
    ASSERT_TRUE(truth.append({i * kFrameNs, T_world_camera}).ok());
  }
  const Similarity planted = some_similarity();
  const auto matches = matches_of(truth, seen_from(truth, planted));
  for (const AlignmentMode mode : {AlignmentMode::kSim3, AlignmentMode::kOriginSim3}) {
    AlignmentRemarks remarks;
    const auto found = align(matches, mode, {}, &remarks);
    ASSERT_TRUE(found.ok()) << found.error().message;
    expect_equal(*found, planted, 1e-8);
    ASSERT_EQ(remarks.notes.size(), 1U);
    EXPECT_THAT(remarks.notes[0], HasSubstr("on a line"));
    EXPECT_THAT(remarks.degenerate.value_or(""), HasSubstr("nearly straight"));
  }
}

/// 1 km along y with whole sways of `sway_m` to both sides: the covariance of the positions has the
/// eigenvalues (1000 m)^2 / 12 along and sway_m^2 / 2 across.
Trajectory swaying_truth(double sway_m) {
  constexpr int kPoses = 2000;
  Trajectory truth;
  for (int i = 0; i < kPoses; ++i) {
    const double share = (i + 0.5) / kPoses;
    const Eigen::Vector3d p(sway_m * std::cos(8.0 * kPi * share), 1000.0 * share, 300.0);
    const Pose T_world_body{R_world_body_from({0.0, 0.0, 0.0}), p};
    EXPECT_TRUE(truth
                    .append({i * kFrameNs,
                             T_world_body * Pose{R_body_camera_nadir(), Eigen::Vector3d::Zero()}})
                    .ok());
  }
  return truth;
}

constexpr AlignmentMode kLeastSquares[] = {
    AlignmentMode::kSe3, AlignmentMode::kSim3, AlignmentMode::kOriginSim3};

/// Where sway_m^2 / 2 is kStraightRatio of the variance along: 12.9 m.
double limit_sway_m() { return 1000.0 * std::sqrt(kStraightRatio / 6.0); }

TEST(Alignment, SaysThatANearlyStraightPathHasNoRotationAboutItself) {
  Similarity planted = some_similarity();
  for (const double sway_m : {0.01, 0.98 * limit_sway_m()}) {
    const Trajectory truth = swaying_truth(sway_m);
    for (const AlignmentMode mode : kLeastSquares) {
      planted.scale = mode == AlignmentMode::kSe3 ? 1.0 : 273.0;
      const Score scored = score(truth, seen_from(truth, planted), {});
      const AlignmentScore& aligned = scored.alignments.at(mode);
      EXPECT_LT(aligned.position_m.max, 1e-6);
      EXPECT_THAT(aligned.degenerate.value_or(""), HasSubstr("nearly straight")) << sway_m;
      EXPECT_FALSE(aligned.rotation_deg) << to_string(mode);
      EXPECT_FALSE(aligned.rotation_euler_norm_deg) << to_string(mode);
    }
    EXPECT_TRUE(score(truth, seen_from(truth, planted), {})
                    .alignments.at(AlignmentMode::kOrigin)
                    .rotation_deg);
  }
  const Trajectory truth = swaying_truth(1.02 * limit_sway_m());
  const Score scored = score(truth, seen_from(truth, planted), {});
  for (const AlignmentMode mode : {AlignmentMode::kSe3, AlignmentMode::kSim3}) {
    const AlignmentScore& aligned = scored.alignments.at(mode);
    EXPECT_FALSE(aligned.degenerate) << aligned.degenerate.value_or("");
    if (mode == AlignmentMode::kSim3) {
      EXPECT_LT(aligned.rotation_deg.value().max, 1e-5);
    }
  }
}

/// What the limit is for: an error of 1 % of the length across a straight path, as odometry makes
/// it, turns the least squares about the path by tens of degrees, while positions are right to it.
TEST(Alignment, DoesNotPrintTheRotationThatDriftGivesAStraightPath) {
  const Trajectory truth = swaying_truth(0.5);
  EstimateTrack track = seen_from(truth, Similarity{});
  for (std::size_t i = 0; i < track.samples.size(); ++i) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(truth.size());
    track.samples[i].T_vo_camera.translation.z() += 10.0 * std::cos(8.0 * kPi * share);
  }
  const auto matches = matches_of(truth, track);
  for (const AlignmentMode mode : kLeastSquares) {
    const Similarity S_world_vo = align(matches, mode, {}).value();
    EXPECT_GT(deg_from_rad(rotation_angle_rad(S_world_vo.rotation, Eigen::Quaterniond::Identity())),
              60.0);
    const AlignmentScore aligned = score(truth, track, {}).alignments.at(mode);
    EXPECT_LT(aligned.position_m.rmse, 15.0);
    EXPECT_TRUE(aligned.degenerate);
    EXPECT_FALSE(aligned.rotation_deg);
  }
}

/// An estimate's own sideways errors must not make a straight truth look like one that turns.
TEST(Alignment, JudgesByTheTruthWhetherAPathIsStraight) {
  const Trajectory truth = swaying_truth(2.0);
  EstimateTrack track = seen_from(truth, Similarity{});
  for (EstimateSample& sample : track.samples) sample.T_vo_camera.translation.x() *= 100.0;
  EXPECT_TRUE(score(truth, track, {}).alignments.at(AlignmentMode::kSim3).degenerate);
}

TEST(Alignment, TwoPosesAreALine) {
  const Trajectory truth = wavy_truth(2);
  const Similarity planted = some_similarity();
  AlignmentRemarks remarks;
  const auto found =
      align(matches_of(truth, seen_from(truth, planted)), AlignmentMode::kSim3, {}, &remarks);
  ASSERT_TRUE(found.ok());
  expect_equal(*found, planted, 1e-7);
  EXPECT_EQ(remarks.notes.size(), 1U);
  EXPECT_TRUE(remarks.degenerate);
}

TEST(Alignment, SaysWhatOnePoseCannotDetermine) {
  const Trajectory truth = wavy_truth(1);
  const auto matches = matches_of(truth, seen_from(truth, some_similarity()));
  EXPECT_TRUE(align(matches, AlignmentMode::kOrigin, {}).ok());
  for (const AlignmentMode mode : {AlignmentMode::kSe3,
                                   AlignmentMode::kSim3,
                                   AlignmentMode::kYawOnly,
                                   AlignmentMode::kOriginSim3}) {
    EXPECT_EQ(align(matches, mode, {}).error().message, "1 matched poses: must be at least 2");
  }
  EXPECT_THAT(align(matches, AlignmentMode::kInitScale, {}).error().message,
              HasSubstr("scale cannot be determined"));
  EXPECT_FALSE(align({}, AlignmentMode::kNone, {}).ok());
}

TEST(Alignment, SaysWhoDoesNotMove) {
  const Trajectory truth = wavy_truth(50);
  EstimateTrack still = seen_from(truth, some_similarity());
  for (EstimateSample& sample : still.samples) {
    sample.T_vo_camera.translation = still.samples.front().T_vo_camera.translation;
  }
  const auto matches = matches_of(truth, still);
  EXPECT_THAT(align(matches, AlignmentMode::kSim3, {}).error().message,
              HasSubstr("the estimate does not move over its 50 poses: scale and rotation"));
  EXPECT_THAT(align(matches, AlignmentMode::kSe3, {}).error().message, HasSubstr("the rotation"));
  EXPECT_THAT(align(matches, AlignmentMode::kYawOnly, {}).error().message, HasSubstr("yaw"));
  EXPECT_THAT(align(matches, AlignmentMode::kInitScale, {}).error().message,
              HasSubstr("the estimate does not move in the first 5 s"));

  std::vector<MatchedPose> swapped = matches;
  for (MatchedPose& match : swapped) std::swap(match.T_world_camera, match.T_vo_camera);
  EXPECT_THAT(align(swapped, AlignmentMode::kSim3, {}).error().message,
              HasSubstr("the truth does not move"));
}

TEST(Alignment, YawOnlyNeedsHorizontalMotion) {
  Trajectory lift;
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(
        lift.append({i * kFrameNs, {Eigen::Quaterniond::Identity(), {5, 5, 1.0 * i}}}).ok());
  }
  EXPECT_THAT(
      align(matches_of(lift, seen_from(lift, {})), AlignmentMode::kYawOnly, {}).error().message,
      HasSubstr("do not move horizontally"));
}

}  // namespace
}  // namespace overfly::evaluation
