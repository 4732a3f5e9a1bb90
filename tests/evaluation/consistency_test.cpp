#include "evaluation/consistency.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

#include "evaluation/errors.hpp"
#include "tests/evaluation/flights.hpp"

namespace overfly::evaluation {
namespace {

/// A covariance with correlations of all errors: of 0.3 m and of 3 mrad, roughly.
Matrix6d stated_covariance() {
  Matrix6d A = Matrix6d::Identity();
  for (int i = 0; i < 36; ++i) A(i / 6, i % 6) += 0.3 * std::sin(1.0 + 2.0 * i);
  Vector6d scale;
  scale << 0.3, 0.2, 0.4, 0.003, 0.002, 0.004;
  A = scale.asDiagonal() * A;
  return A * A.transpose();
}

/// Poses of the wavy flight, each with an independent Gaussian error of this covariance. The
/// estimator's frame stands in the world by S_world_vo, and so does the covariance that it states.
EstimateTrack noisy_track(const Trajectory& truth,
                          const Similarity& S_world_vo,
                          const Matrix6d& covariance,
                          double stated_share,
                          unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const Matrix6d L = Eigen::LLT<Matrix6d>(covariance).matrixL();
  PoseCovariance stated;
  stated.matrix = stated_share * in_target(S_world_vo.inverse(), covariance);
  const auto shared = std::make_shared<const PoseCovariance>(stated);
  EstimateTrack track = seen_from(truth, S_world_vo);
  for (EstimateSample& sample : track.samples) {
    Vector6d error;
    for (double& value : error) value = normal(random);
    error = L * error;
    const Eigen::Vector3d theta = error.tail<3>();
    Pose estimate = S_world_vo * sample.T_vo_camera;
    // The truth is exp(theta) times the estimate.
    estimate.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(-theta.norm(), theta.normalized())) *
                        estimate.rotation;
    estimate.translation -= error.head<3>();
    sample.T_vo_camera = S_world_vo.inverse() * estimate;
    sample.covariance = shared;
  }
  return track;
}

Consistency consistency_by(const Score& score, AlignmentMode mode) {
  return score.alignments.at(mode).consistency.value();
}

TEST(Consistency, BandsAreThoseOfTheChiSquareDistribution) {
  // 2.5 % and 97.5 % quantiles: tables of the chi-square distribution.
  const Nees one = nees_of({3.0}, 3);
  EXPECT_NEAR(one.band_95.low, 0.2158, 1e-4);
  EXPECT_NEAR(one.band_95.high, 9.3484, 1e-4);
  const Nees fifty = nees_of(std::vector<double>(50, 2.0), 2);  // 100 degrees of freedom
  EXPECT_NEAR(fifty.band_95.low, 74.2219 / 50.0, 1e-5);
  EXPECT_NEAR(fifty.band_95.high, 129.5612 / 50.0, 1e-5);
  EXPECT_NEAR(fifty.pose_band_95.low, 0.0506, 1e-4);
  EXPECT_NEAR(fifty.pose_band_95.high, 7.3778, 1e-4);
  EXPECT_EQ(fifty.share_in_band, 1.0);
}

TEST(Consistency, MeanMarksTheEstimator) {
  const Nees consistent = nees_of({2.0, 4.0, 3.5, 2.5}, 3);
  EXPECT_EQ(consistent.honesty, Honesty::kConsistent);
  EXPECT_EQ(consistent.mean, 3.0);
  EXPECT_DOUBLE_EQ(consistent.deviation_ratio(), 1.0);
  const Nees overconfident = nees_of({12.0, 20.0, 4.0, 12.0}, 3);
  EXPECT_EQ(overconfident.honesty, Honesty::kOverconfident);
  EXPECT_DOUBLE_EQ(overconfident.deviation_ratio(), 2.0);
  EXPECT_EQ(overconfident.share_in_band, 0.25);
  EXPECT_EQ(nees_of({0.1, 0.2, 0.1, 0.1}, 3).honesty, Honesty::kTooCautious);
  Consistency both;
  EXPECT_FALSE(both.honesty());
  both.position = consistent;
  EXPECT_EQ(both.honesty(), Honesty::kConsistent);
  both.rotation = nees_of({0.1, 0.2, 0.1, 0.1}, 3);
  EXPECT_EQ(both.honesty(), Honesty::kTooCautious);
  both.pose = overconfident;
  EXPECT_EQ(both.honesty(), Honesty::kOverconfident);
  for (const Honesty honesty :
       {Honesty::kConsistent, Honesty::kOverconfident, Honesty::kTooCautious}) {
    EXPECT_EQ(honesty_from(to_string(honesty)), honesty);
  }
  EXPECT_FALSE(honesty_from("humble"));
}

/// Gaussian errors of the stated covariance: the mean is outside of the band in 5 % of the flights.
/// With 400 flights the number outside is 20 +- 4.4; the limits are at 3.2 standard deviations.
TEST(Consistency, HonestEstimatorIsInTheBandInNinetyFivePercentOfFlights) {
  const Trajectory truth = wavy_truth(60);
  int outside_position = 0;
  int outside_pose = 0;
  double share_in_band = 0.0;
  constexpr int kFlights = 400;
  for (unsigned seed = 1; seed <= kFlights; ++seed) {
    const EstimateTrack track = noisy_track(truth, {}, stated_covariance(), 1.0, seed);
    AlignmentScore alignment;
    const auto matches = associate(truth, track, {});
    const Consistency consistency = consistency_of(*matches, alignment).value();
    EXPECT_EQ(consistency.position->samples, 60);
    outside_position += consistency.position->honesty != Honesty::kConsistent ? 1 : 0;
    outside_pose += consistency.pose->honesty != Honesty::kConsistent ? 1 : 0;
    share_in_band += consistency.pose->share_in_band / kFlights;
  }
  EXPECT_GE(outside_position, 6);
  EXPECT_LE(outside_position, 34);
  EXPECT_GE(outside_pose, 6);
  EXPECT_LE(outside_pose, 34);
  EXPECT_NEAR(share_in_band, 0.95, 0.006);
}

TEST(Consistency, CovarianceDividedByFourIsOverconfidentByAFactorOfTwo) {
  const Trajectory truth = wavy_truth(500);
  const EstimateTrack track = noisy_track(truth, {}, stated_covariance(), 0.25, 7);
  const Score scored = score(truth, track, {});
  const Consistency consistency = consistency_by(scored, AlignmentMode::kNone);
  EXPECT_EQ(consistency.honesty(), Honesty::kOverconfident);
  for (const auto& part : {consistency.position, consistency.rotation, consistency.pose}) {
    ASSERT_TRUE(part);
    EXPECT_EQ(part->honesty, Honesty::kOverconfident);
    EXPECT_EQ(part->samples, 500);
    EXPECT_NEAR(part->deviation_ratio(), 2.0, 0.1);
  }
  const EstimateTrack cautious = noisy_track(truth, {}, stated_covariance(), 4.0, 7);
  EXPECT_EQ(consistency_by(score(truth, cautious, {}), AlignmentMode::kNone).honesty(),
            Honesty::kTooCautious);
}

/// The same errors in another frame have the same NEES, if the covariance is turned and scaled with
/// the alignment.
TEST(Consistency, AlignmentMovesTheCovarianceToo) {
  const Trajectory truth = wavy_truth(500);
  const Matrix6d P = stated_covariance();
  const Score in_world = score(truth, noisy_track(truth, {}, P, 1.0, 3), {});
  const Score in_vo = score(truth, noisy_track(truth, some_similarity(), P, 1.0, 3), {});
  for (const AlignmentMode mode : {AlignmentMode::kSim3, AlignmentMode::kInitScale}) {
    const Consistency a = consistency_by(in_world, mode);
    const Consistency b = consistency_by(in_vo, mode);
    EXPECT_NEAR(a.position->mean, b.position->mean, 1e-5 * a.position->mean) << to_string(mode);
    EXPECT_NEAR(a.rotation->mean, b.rotation->mean, 1e-5 * a.rotation->mean) << to_string(mode);
    EXPECT_NEAR(a.pose->mean, b.pose->mean, 1e-5 * a.pose->mean) << to_string(mode);
  }
  // A fit to 500 poses with independent errors hardly changes them.
  EXPECT_EQ(consistency_by(in_vo, AlignmentMode::kSim3).honesty(), Honesty::kConsistent);
  EXPECT_EQ(consistency_by(in_vo, AlignmentMode::kSim3).position->samples, 500);
  EXPECT_EQ(consistency_by(in_vo, AlignmentMode::kInitScale).position->samples, 499)
      << "the first pose has no error by this alignment";
}

TEST(Consistency, CountsWhatCannotBeScored) {
  const Trajectory truth = wavy_truth(50);
  EstimateTrack track = noisy_track(truth, {}, stated_covariance(), 1.0, 5);
  PoseCovariance flat;
  flat.matrix = stated_covariance();
  flat.matrix.row(2).setZero();
  flat.matrix.col(2).setZero();
  track.samples[10].covariance = std::make_shared<const PoseCovariance>(flat);
  PoseCovariance position_only = flat;
  position_only.matrix = stated_covariance();
  position_only.has_rotation = false;
  track.samples[11].covariance = std::make_shared<const PoseCovariance>(position_only);
  track.samples[12].covariance.reset();
  track.samples[12].covariance_left_out = true;
  track.samples[13].covariance.reset();
  track.samples[14].state = TrackingState::kLost;
  const Score scored = score(truth, track, {});
  EXPECT_EQ(scored.covariances.stated, 47);
  EXPECT_EQ(scored.covariances.left_out, 1);
  const Consistency consistency = consistency_by(scored, AlignmentMode::kNone);
  EXPECT_EQ(consistency.singular, 1);
  EXPECT_EQ(consistency.position->samples, 46);
  EXPECT_EQ(consistency.rotation->samples, 46);  // also that of the singular position
  EXPECT_EQ(consistency.pose->samples, 45);

  const Score without = score(truth, seen_from(truth, {}), {});
  EXPECT_FALSE(without.covariances.any());
  EXPECT_FALSE(without.alignments.at(AlignmentMode::kNone).consistency);
}

/// Of a straight path the alignment does not determine the rotation.
TEST(Consistency, DegenerateAlignmentHasOnlyPositions) {
  Trajectory truth;
  for (int i = 0; i < 100; ++i) {
    const Pose T_world_camera{R_body_camera_nadir(), {2.0 * i, 0.0, 100.0}};
    ASSERT_TRUE(truth.append({i * kFrameNs, T_world_camera}).ok());
  }
  const EstimateTrack track = noisy_track(truth, {}, 1e-4 * stated_covariance(), 1.0, 2);
  const Consistency sim3 = consistency_by(score(truth, track, {}), AlignmentMode::kSim3);
  EXPECT_TRUE(sim3.position);
  EXPECT_FALSE(sim3.rotation);
  EXPECT_FALSE(sim3.pose);
}

}  // namespace
}  // namespace overfly::evaluation
