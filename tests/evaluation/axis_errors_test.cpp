// Errors along and across the true path, against closed forms.
#include "evaluation/axis_errors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/evaluation/flights.hpp"

namespace overfly::evaluation {
namespace {

/// Every truth pose, matched with an estimate that is off by `offset(pose)` [m].
template <typename Offset>
std::vector<MatchedPose> matches_off_by(const Trajectory& truth, const Offset& offset) {
  std::vector<MatchedPose> matches;
  for (const StampedPose& stamped : truth.poses()) {
    Pose estimate = stamped.pose;
    estimate.translation += offset(stamped.pose);
    matches.push_back({stamped.t_ns, stamped.pose, estimate, {}});
  }
  return matches;
}

Trajectory flown(int poses, const std::function<Eigen::Vector3d(double)>& place_at_s) {
  Trajectory truth;
  for (int i = 0; i < poses; ++i) {
    const Pose pose{Eigen::Quaterniond::Identity(), place_at_s(s_from_ns(i * kFrameNs))};
    EXPECT_TRUE(truth.append({i * kFrameNs, pose}).ok());
  }
  return truth;
}

const Pose kMount{R_body_camera_nadir(), Eigen::Vector3d(0.3, 0.0, 0.1)};

TEST(AxisErrors, OfAStraightFlightAreTheComponentsOfTheOffset) {
  const Trajectory east =
      flown(40, [](double t_s) { return Eigen::Vector3d(20.0 * t_s, 5.0, 100.0); });
  const Eigen::Vector3d offset(1.0, 2.0, 3.0);
  for (const AxisError& error :
       axis_errors(east, matches_off_by(east, [&](const Pose&) { return offset; }), {}, {})) {
    EXPECT_NEAR(error.along_m, 1.0, 1e-9);
    EXPECT_NEAR(error.across_m, -2.0, 1e-9);  // north is to the left
    EXPECT_NEAR(error.up_m, 3.0, 1e-9);
  }
}

/// Counterclockwise around the origin, outward is to the right, also at both ends of the flight.
TEST(AxisErrors, OfATurnFollowItsDirection) {
  constexpr double kRadiusM = 100.0;
  constexpr double kRateRadS = 0.25;
  const Trajectory turn = flown(300, [](double t_s) {
    return Eigen::Vector3d(
        kRadiusM * std::cos(kRateRadS * t_s), kRadiusM * std::sin(kRateRadS * t_s), 50.0);
  });
  const auto outward = [&](const Pose& pose) {
    Eigen::Vector3d out = pose.translation / kRadiusM;
    out.z() = 0.0;
    return Eigen::Vector3d(2.0 * out);
  };
  const std::vector<AxisError> errors =
      axis_errors(turn, matches_off_by(turn, outward), {}, kMount);
  ASSERT_EQ(errors.size(), 300U);
  for (std::size_t i = 1; i < errors.size(); ++i) {
    // The direction is that of the last 0.1 s: it lags by half of that at most, and by a tenth more
    // because the truth is interpolated along chords.
    EXPECT_NEAR(errors[i].across_m, 2.0, 1e-3) << i;
    EXPECT_LE(std::abs(errors[i].along_m), 2.0 * 0.055 * kRateRadS) << i;
  }
}

/// On the ground and while hovering the nose gives the direction.
TEST(AxisErrors, AreInTheAxesOfTheNoseWhileTheTruthStands) {
  const Pose heading_west{R_world_body_from({0.4, 0.3, rad_from_deg(270.0)}), {7.0, 8.0, 9.0}};
  Trajectory still;
  for (int i = 0; i < 10; ++i)
    ASSERT_TRUE(still.append({i * kFrameNs, heading_west * kMount}).ok());
  const std::vector<AxisError> errors =
      axis_errors(still,
                  matches_off_by(still, [](const Pose&) { return Eigen::Vector3d(-3, 4, 12); }),
                  {},
                  kMount);
  for (const AxisError& error : errors) {
    EXPECT_NEAR(error.along_m, 3.0, 1e-9);
    EXPECT_NEAR(error.across_m, 4.0, 1e-9);  // north is to the right
  }
  EXPECT_NEAR(rmse_of(errors).horizontal_m, 5.0, 1e-12);
  EXPECT_NEAR(rmse_of(errors).vertical_m, 12.0, 1e-12);
  // Straight up: no direction at all.
  const Pose up{R_world_body_from({0.0, rad_from_deg(90.0), 0.0}), Eigen::Vector3d::Zero()};
  EXPECT_NEAR(
      axis_error({}, 0, up * kMount, (up * kMount).translation + Eigen::Vector3d(2, 0, 0), kMount)
          .along_m,
      2.0,
      1e-9);
  EXPECT_TRUE(axis_errors({}, {}, {}, kMount).empty());
  EXPECT_EQ(rmse_of({}).horizontal_m, 0.0);
}

/// The threshold is a speed of 1 m/s, also at the second pose, where less than 0.1 s is known.
TEST(AxisErrors, FollowTheMotionFromOneMetreASecond) {
  for (const double speed_m_s : {0.99, 1.01}) {
    const Trajectory north =
        flown(10, [&](double t_s) { return Eigen::Vector3d(0.0, speed_m_s * t_s, 0.0); });
    const std::vector<AxisError> errors = axis_errors(
        north, matches_off_by(north, [](const Pose&) { return Eigen::Vector3d(0, 5, 0); }), {}, {});
    // The nose points to the east.
    for (std::size_t i = 1; i < errors.size(); ++i) {
      EXPECT_NEAR(errors[i].along_m, speed_m_s > 1.0 ? 5.0 : 0.0, 1e-9) << speed_m_s << " " << i;
    }
    EXPECT_NEAR(errors[0].along_m, 0.0, 1e-9);
  }
}

/// The parts add up to what is scored, in each alignment.
TEST(AxisErrors, AddUpToTheScore) {
  Trajectory truth;
  Trajectory estimate;
  for (int i = 0; i < 120; ++i) {
    const double t_s = 0.2 * i;
    if (i == 60) truth.append_gap();
    const Pose pose{Eigen::Quaterniond::Identity(),
                    {12.0 * t_s, 0.4 * t_s * t_s, 100.0 + 4.0 * std::sin(t_s)}};
    ASSERT_TRUE(truth.append({i * kFrameNs, pose}).ok());
    Pose drifted = pose;
    drifted.translation *= 0.4 + 0.001 * t_s;
    drifted.translation.z() += 0.02 * t_s * t_s;
    ASSERT_TRUE(estimate.append({i * kFrameNs, drifted}).ok());
  }
  const EstimateTrack track = seen_from(estimate, {});
  const Score scored = score(truth, track, {});
  const auto matches = associate(truth, track, {});
  ASSERT_TRUE(matches.ok());
  EXPECT_GT(scored.alignments.size(), 4U);
  for (const auto& [mode, alignment] : scored.alignments) {
    const std::vector<AxisError> errors =
        axis_errors(truth, *matches, alignment.S_world_vo, kMount);
    ASSERT_EQ(errors.size(), alignment.position_errors_m.size());
    for (std::size_t i = 0; i < errors.size(); ++i) {
      const Eigen::Vector3d parts(errors[i].along_m, errors[i].across_m, errors[i].up_m);
      EXPECT_NEAR(parts.norm(), alignment.position_errors_m[i], 1e-9);
      EXPECT_EQ(errors[i].t_ns, scored.matched_t_ns[i]);
    }
    const AxisRmse rmse = rmse_of(errors);
    EXPECT_NEAR(std::hypot(rmse.horizontal_m, rmse.vertical_m), alignment.position_m.rmse, 1e-9);
    EXPECT_NEAR(std::hypot(rmse.along_m, rmse.across_m), rmse.horizontal_m, 1e-9);
  }
}

}  // namespace
}  // namespace overfly::evaluation
