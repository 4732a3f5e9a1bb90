#include "odometry/geometry/motion_model.hpp"

#include <gtest/gtest.h>

namespace overfly::odometry {
namespace {

constexpr std::int64_t kStepNs = 32258065;

/// A camera that moves and rolls steadily.
Pose T_camera_vo_at(std::int64_t t_ns) {
  const double t_s = static_cast<double>(t_ns) * 1e-9;
  const Pose T_vo_camera{Eigen::Quaterniond(exp_so3({0.2 * t_s, 1.1 * t_s, -0.1 * t_s})),
                         {0.1 * t_s, 0.02 * t_s, -0.05 * t_s}};
  return T_vo_camera.inverse();
}

TEST(MotionModel, PredictsSteadyMotionExactly) {
  MotionModel motion;
  motion.observe(0, T_camera_vo_at(0));
  motion.observe(kStepNs, T_camera_vo_at(kStepNs));
  const Pose truth = T_camera_vo_at(3 * kStepNs);
  const Pose turned = motion.predict(3 * kStepNs);
  EXPECT_LT((turned.translation - truth.translation).norm(), 1e-9);
  EXPECT_LT(rotation_angle_rad(turned.rotation, truth.rotation), 1e-9);
  // Without the turn the attitude stays that of the last pose, the position goes on.
  const Pose unturned = motion.predict_unturned(3 * kStepNs);
  EXPECT_LT(rotation_angle_rad(unturned.rotation, T_camera_vo_at(kStepNs).rotation), 1e-9);
  EXPECT_LT((unturned.inverse().translation - truth.inverse().translation).norm(), 1e-9);
}

TEST(MotionModel, StandsStillUntilItKnowsTwoPoses) {
  MotionModel motion;
  motion.observe(kStepNs, T_camera_vo_at(kStepNs));
  EXPECT_EQ(motion.speed(), 0.0);
  EXPECT_EQ(motion.rate_rad_s(), 0.0);
  motion.observe(2 * kStepNs, T_camera_vo_at(2 * kStepNs));
  EXPECT_GT(motion.speed(), 0.1);
  EXPECT_GT(motion.rate_rad_s(), 1.0);
  motion.reset();
  EXPECT_EQ(motion.speed(), 0.0);
}

TEST(MotionModel, ExtrapolatesNoFurtherThanAsked) {
  MotionModel motion;
  motion.observe(0, T_camera_vo_at(0));
  motion.observe(kStepNs, T_camera_vo_at(kStepNs));
  const Pose late = motion.predict(kStepNs + 60000000000, 0.5);
  const Pose half = motion.predict(kStepNs + 500000000, 0.5);
  EXPECT_EQ(late.translation, half.translation);
}

}  // namespace
}  // namespace overfly::odometry
