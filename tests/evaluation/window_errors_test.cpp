#include "evaluation/window_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include "core/motion/pose.hpp"
#include "evaluation/errors.hpp"
#include "evaluation/evaluation.hpp"

namespace overfly::evaluation {
namespace {

/// A climbing turn with steps of equal length, and an estimate whose scale, heading and noise
/// change.
class WindowErrorsOfAFlight : public ::testing::Test {
 protected:
  WindowErrorsOfAFlight() {
    constexpr double kRadius_m = 200.0;
    constexpr double kStep_m = 1.37;
    for (int k = 0; k < 700; ++k) {
      const double angle_rad = kStep_m * k / kRadius_m;
      const auto about_up = [](double rad) {
        return Eigen::Quaterniond(Eigen::AngleAxisd(rad, Eigen::Vector3d::UnitZ()));
      };
      const Eigen::Vector3d place(
          kRadius_m * std::sin(angle_rad), -kRadius_m * std::cos(angle_rad), 0.1 * k);
      const Pose truth{about_up(angle_rad), place};
      const double scale = 1.0 + 1e-4 * k;
      const Pose estimate{
          about_up(angle_rad + 2e-4 * k),
          scale * place + 0.3 * Eigen::Vector3d(std::sin(0.7 * k), std::cos(k), 1.0)};
      pairs.emplace_back(PosePair{0, truth, estimate});
      MatchedPose match;
      match.t_ns = k;
      match.T_world_camera = truth;
      matches.push_back(match);
      estimates.push_back(estimate);
    }
  }

  std::vector<std::optional<PosePair>> pairs;
  std::vector<MatchedPose> matches;
  std::vector<Pose> estimates;
};

/// The score averages pairs from every tenth pose on; at a constant speed each ends one of the
/// instants.
TEST_F(WindowErrorsOfAFlight, AverageToTheRelativeErrorOfTheScore) {
  const auto scored = relative_errors(matches, estimates, {kErrorWindow_m});
  ASSERT_EQ(scored.size(), 1U);
  const auto errors = relative_errors_along(pairs);
  std::size_t end = 0;
  while (!errors[end]) ++end;
  std::vector<double> translation;
  std::vector<double> rotation_rad_m;
  for (; end < pairs.size(); end += 10) {
    const auto& error = errors[end];
    ASSERT_TRUE(error);
    translation.push_back(error->translation);
    rotation_rad_m.push_back(error->rotation_rad_m);
  }
  ASSERT_EQ(translation.size(), static_cast<std::size_t>(scored[0].pairs));
  const auto mean = [](const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  };
  EXPECT_NEAR(100.0 * mean(translation), scored[0].translation_mean_percent, 1e-9);
  EXPECT_NEAR(
      100.0 * deg_from_rad(mean(rotation_rad_m)), scored[0].rotation_mean_deg_per_100m, 1e-9);
  EXPECT_GT(scored[0].translation_mean_percent, 1.0);
}

TEST_F(WindowErrorsOfAFlight, FollowThePathAndNotTheChord) {
  // The path is longer than its chord: the relative error is there first.
  const auto errors = relative_errors_along(pairs);
  std::size_t first = 0;
  while (!errors[first]) ++first;
  EXPECT_FALSE(scale_error_at(pairs, first));
  EXPECT_TRUE(scale_error_at(pairs, first + 1));
}

TEST_F(WindowErrorsOfAFlight, LeaveOutInstantsWithoutAnEstimate) {
  const auto whole = relative_errors_along(pairs)[400];
  for (std::size_t k = 380; k < 400; ++k) pairs[k].reset();
  const auto with_gap = relative_errors_along(pairs)[400];
  ASSERT_TRUE(whole && with_gap);
  EXPECT_NEAR(with_gap->translation, whole->translation, 0.2 * whole->translation);
  pairs[379]->map_id = 1;
  EXPECT_FALSE(relative_errors_along(pairs)[400]) << "another map";
}

/// A loop of 60 m that was flown while the estimator was lost belongs to the path.
TEST_F(WindowErrorsOfAFlight, CountTheDetourOfAGap) {
  for (std::size_t k = 350; k < 370; ++k) pairs[k].reset();
  pairs[370]->detour_m = 60.0;
  pairs.resize(380);
  const auto errors = relative_errors_along(pairs);
  ASSERT_TRUE(errors[370]);
  // Of the 100 m 60 are the detour, 28.8 the 21 steps over the gap, and the rest was flown before
  // it.
  std::vector<std::optional<PosePair>> last(pairs.begin() + 340, pairs.end());
  EXPECT_TRUE(relative_errors_along(last)[30]);
  last.erase(last.begin(), last.begin() + 2);
  EXPECT_FALSE(relative_errors_along(last)[28]);
}

/// The window is searched among the same number of poses, whatever is before it.
TEST_F(WindowErrorsOfAFlight, OfAVehicleThatIsSlowAreEmpty) {
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    pairs[k]->T_world_camera.translation = Eigen::Vector3d(0.05 * static_cast<double>(k), 0.0, 0.0);
  }
  while (pairs.size() < 4000) {
    pairs.push_back(pairs.back());
    pairs.back()->T_world_camera.translation.x() += 0.05;
  }
  for (const auto& error : relative_errors_along(pairs)) EXPECT_FALSE(error);
}

}  // namespace
}  // namespace overfly::evaluation
