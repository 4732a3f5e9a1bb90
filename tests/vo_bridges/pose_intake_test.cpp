#include "vo_bridges/pose_intake.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace overfly {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

VoEstimate answer(std::int64_t frame, double x = 1.0, double w = 1.0) {
  VoEstimate estimate;
  estimate.sample.frame = frame;
  estimate.sample.state = TrackingState::kTracking;
  estimate.sample.T_vo_camera.translation.x() = x;
  estimate.sample.T_vo_camera.rotation.w() = w;
  estimate.sample.scene_depth = 2.0;
  return estimate;
}

TEST(PoseIntake, OneThatIsNoneIsALostFrameWithAWarning) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (VoEstimate odd : {answer(7, kNan),
                         answer(7, infinity),
                         answer(7, -2e12),
                         answer(7, 1.0, 1.01),
                         answer(7, 1.0, 0.0),
                         answer(7, 1.0, kNan)}) {
    PoseIntake poses;
    EXPECT_TRUE(poses.take(odd));
    EXPECT_EQ(odd.sample.state, TrackingState::kLost);
    EXPECT_EQ(odd.sample.T_vo_camera.translation, Eigen::Vector3d::Zero());
    EXPECT_FALSE(odd.sample.scene_depth.has_value());
    EXPECT_THAT(poses.take_notes(), ElementsAre(HasSubstr("warning: frame 7: the ")));
    EXPECT_THAT(poses.take_notes(), IsEmpty());
  }
}

TEST(PoseIntake, TakesWhatADoorSaysOfThePose) {
  PoseIntake poses;
  VoEstimate odd = answer(3);
  odd.pose_fault = "half of it is missing";
  EXPECT_TRUE(poses.take(odd));
  EXPECT_EQ(odd.sample.state, TrackingState::kLost);
  EXPECT_EQ(odd.pose_fault, "") << "it is told once";
  EXPECT_THAT(poses.take_notes(), ElementsAre(HasSubstr("frame 3: half of it is missing")));
}

TEST(PoseIntake, KeepsAPoseAndItsRoundedQuaternion) {
  PoseIntake poses;
  VoEstimate exact = answer(0);
  exact.sample.T_vo_camera.rotation.coeffs() = Eigen::Vector4d(0.0, 0.0, 0.6, 0.8);
  EXPECT_TRUE(poses.take(exact));
  EXPECT_EQ(exact.sample.T_vo_camera.rotation.coeffs(), Eigen::Vector4d(0.0, 0.0, 0.6, 0.8));
  VoEstimate rounded = answer(1, 1.0, 1.0009);
  EXPECT_TRUE(poses.take(rounded));
  EXPECT_EQ(rounded.sample.state, TrackingState::kTracking);
  EXPECT_DOUBLE_EQ(rounded.sample.T_vo_camera.rotation.norm(), 1.0);
  VoEstimate lost = answer(2, kNan);
  lost.sample.state = TrackingState::kLost;
  EXPECT_TRUE(poses.take(lost)) << "no pose is claimed";
  EXPECT_EQ(lost.sample.T_vo_camera.translation.x(), 0.0);
  EXPECT_THAT(poses.take_notes(), IsEmpty());
}

TEST(PoseIntake, LeavesOutADepthThatIsNoneAndSaysSoOnce) {
  PoseIntake poses;
  for (const double depth : {kNan, -2.0}) {
    VoEstimate odd = answer(4);
    odd.sample.scene_depth = depth;
    EXPECT_TRUE(poses.take(odd));
    EXPECT_EQ(odd.sample.state, TrackingState::kTracking);
    EXPECT_FALSE(odd.sample.scene_depth.has_value());
  }
  EXPECT_THAT(poses.take_notes(), ElementsAre(HasSubstr("warning: frame 4: scene depth = ")));
}

TEST(PoseIntake, LeavesOutAMapPointThatIsNotFiniteAndSaysSoOnce) {
  PoseIntake poses;
  const Eigen::Vector3f far(1.0F, 2.0F, std::numeric_limits<float>::infinity());
  for (int i = 4; i < 6; ++i) {
    VoEstimate odd = answer(i);
    odd.map_points_vo = {{1.0F, 2.0F, 3.0F}, far};
    EXPECT_TRUE(poses.take(odd));
    EXPECT_EQ(odd.sample.state, TrackingState::kTracking);
    EXPECT_THAT(odd.map_points_vo, ElementsAre(Eigen::Vector3f(1.0F, 2.0F, 3.0F)));
  }
  EXPECT_THAT(poses.take_notes(), ElementsAre(HasSubstr("warning: frame 4: a map point is not")));
}

TEST(PoseIntake, GivesUpAfterManyInARow) {
  PoseIntake poses;
  for (int i = 0; i < 10 * PoseIntake::kMostInARow; ++i) {
    VoEstimate estimate = i % PoseIntake::kMostInARow == 5 ? answer(i) : answer(i, kNan);
    EXPECT_TRUE(poses.take(estimate)) << "a good one in between starts again";
  }
  EXPECT_THAT(poses.take_notes(), SizeIs(PoseIntake::kMostNotes));
  poses = {};
  for (int i = 0; i + 1 < PoseIntake::kMostInARow; ++i) {
    VoEstimate estimate = answer(i, kNan);
    EXPECT_TRUE(poses.take(estimate)) << i;
  }
  VoEstimate last = answer(77, kNan);
  const Status given_up = poses.take(last);
  ASSERT_FALSE(given_up);
  EXPECT_EQ(given_up.error().code, ErrorCode::kInternal);
  EXPECT_EQ(given_up.error().message,
            "30 answers in a row had no usable pose, the last one for frame 77: the position "
            "is not finite");
}

TEST(PoseIntake, TakesACovarianceThatIsOne) {
  PoseIntake poses;
  VoEstimate estimate = answer(1);
  estimate.covariance = {4, 1, 0, 1, 5, 2, 0, 2, 6};
  ASSERT_TRUE(poses.take(estimate));
  ASSERT_NE(estimate.sample.covariance, nullptr);
  EXPECT_EQ(estimate.sample.covariance->matrix(1, 2), 2.0);
  EXPECT_THAT(estimate.covariance, IsEmpty());
  ASSERT_TRUE(poses.take(estimate)) << "an answer passes two of these";
  EXPECT_NE(estimate.sample.covariance, nullptr);
  EXPECT_THAT(poses.take_notes(), IsEmpty());

  VoEstimate unstated = answer(2);
  unstated.covariance.assign(36, 0.0);
  ASSERT_TRUE(poses.take(unstated));
  EXPECT_EQ(unstated.sample.covariance, nullptr);
  EXPECT_FALSE(unstated.sample.covariance_left_out);

  VoEstimate lost = answer(3);
  lost.sample.state = TrackingState::kLost;
  lost.covariance = {4, 1, 0, 1, 5, 2, 0, 2, 6};
  ASSERT_TRUE(poses.take(lost));
  EXPECT_EQ(lost.sample.covariance, nullptr) << "there is no pose";
}

TEST(PoseIntake, LeavesOutACovarianceThatIsNoneAndKeepsThePose) {
  PoseIntake poses;
  for (const std::vector<double>& odd : {std::vector<double>{4, 1, 0, 1, 5, kNan, 0, 2, 6},
                                         std::vector<double>{4, 1, 0, 2, 5, 2, 0, 2, 6},
                                         std::vector<double>{-4, 0, 0, 0, 5, 2, 0, 2, 6},
                                         std::vector<double>{1, 2}}) {
    VoEstimate estimate = answer(6);
    estimate.covariance = odd;
    ASSERT_TRUE(poses.take(estimate));
    EXPECT_EQ(estimate.sample.state, TrackingState::kTracking);
    EXPECT_EQ(estimate.sample.T_vo_camera.translation.x(), 1.0);
    EXPECT_EQ(estimate.sample.covariance, nullptr);
    EXPECT_TRUE(estimate.sample.covariance_left_out);
  }
  EXPECT_THAT(poses.take_notes(),
              ElementsAre(HasSubstr("warning: frame 6: covariance: value (2, 3) = nan")))
      << "told once";
}

}  // namespace
}  // namespace overfly
