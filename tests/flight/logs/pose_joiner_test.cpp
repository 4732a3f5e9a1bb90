#include "flight/logs/truth/pose_joiner.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/motion/pose.hpp"
#include "core/time.hpp"

namespace overfly::flight::logs {
namespace {

using ::testing::HasSubstr;

Eigen::Quaterniond yaw_of(double angle_rad) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()));
}

/// A turn at 0.1 rad/s: SLERP between samples is exact.
Eigen::Quaterniond turn_at(std::int64_t t_ns) { return yaw_of(0.1 * s_from_ns(t_ns)); }

/// Samples of 200 s: attitudes at 100 Hz and positions at 50 Hz, out of order by up to 1.9 s, as
/// BootClock lets them through. Far more than are joined at once.
TEST(PoseJoiner, InterpolatesSamplesThatAreOutOfOrder) {
  std::mt19937 random(7);
  const auto between = [&](std::int64_t most) {
    return static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(most));
  };
  struct Sample {
    std::int64_t met_ns;
    std::int64_t t_ns;
    bool attitude;
  };
  std::vector<Sample> samples;
  for (std::int64_t i = 0; i < 20'000; ++i) {
    const std::int64_t t_ns = i * kNsPerS / 100;
    samples.push_back({t_ns + between(1'900'000'000), t_ns, true});
    if (i % 2 == 0) samples.push_back({t_ns + 900'000'000, t_ns + 3'000'000, false});
  }
  std::stable_sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) {
    return a.met_ns < b.met_ns;
  });
  PoseJoiner joiner;
  joiner.expect(10'000);
  for (const Sample& sample : samples) {
    if (sample.attitude) {
      joiner.attitude({0, sample.t_ns}, turn_at(sample.t_ns));
    } else {
      joiner.position({0, sample.t_ns}, {1e-9 * static_cast<double>(sample.t_ns), 2.0, 3.0});
    }
  }
  std::vector<std::string> warnings;
  const std::vector<LogPose> poses = joiner.take_poses(warnings).poses;
  EXPECT_THAT(warnings, ::testing::IsEmpty());
  ASSERT_EQ(poses.size(), 10'000U);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto t_ns = static_cast<std::int64_t>(i) * kNsPerS / 50 + 3'000'000;
    ASSERT_EQ(poses[i].t_ns, t_ns);
    ASSERT_EQ(poses[i].position.x(), 1e-9 * static_cast<double>(t_ns));
    // Attitudes are kept as float.
    ASSERT_LT(rotation_angle_rad(poses[i].R_ned_body, turn_at(t_ns)), 1e-6) << i;
  }
}

TEST(PoseJoiner, ReportsWhatItLeavesOut) {
  PoseJoiner joiner;
  for (int i = 0; i < 5; ++i) joiner.attitude({0, i * kNsPerS}, turn_at(i * kNsPerS));
  joiner.attitude({0, 2 * kNsPerS}, yaw_of(3.0));    // a second one for that time
  joiner.position({0, kNsPerS / 2}, {1, 0, 0});      //
  joiner.position({0, kNsPerS / 2}, {2, 0, 0});      // not later
  joiner.position({0, 2 * kNsPerS}, {3, 0, 0});      //
  joiner.position({0, 4 * kNsPerS + 1}, {4, 0, 0});  // after the last attitude
  joiner.position({1, kNsPerS}, {5, 0, 0});          // after a restart
  std::vector<std::string> warnings;
  const std::vector<LogPose> poses = joiner.take_poses(warnings).poses;
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[1].position.x(), 3.0);
  EXPECT_LT(rotation_angle_rad(poses[1].R_ned_body, turn_at(2 * kNsPerS)), 1e-6);
  EXPECT_THAT(warnings,
              ::testing::ElementsAre(HasSubstr("1 positions of 1 other runs of the clock"),
                                     HasSubstr("1 attitudes were left out: a time that"),
                                     HasSubstr("1 positions were left out: not later than"),
                                     HasSubstr("1 positions were left out: no attitude on")));
}

TEST(PoseJoiner, TakesTheRunWithTheMostPositions) {
  PoseJoiner joiner;
  joiner.expect(10'000);
  for (std::uint32_t boot = 0; boot < 3; ++boot) {
    const int count = boot == 1 ? 6'000 : 5'000;
    for (int i = 0; i < count; ++i) {
      joiner.attitude({boot, i * kNsPerS / 50}, yaw_of(0.1 * boot));
      joiner.position({boot, i * kNsPerS / 50}, {1.0 * boot, 0, 0});
    }
  }
  std::vector<std::string> warnings;
  const auto [boot, poses] = joiner.take_poses(warnings);
  EXPECT_EQ(boot, 1U);
  ASSERT_EQ(poses.size(), 6'000U);
  EXPECT_EQ(poses.back().position.x(), 1.0);
  EXPECT_LT(rotation_angle_rad(poses.back().R_ned_body, yaw_of(0.1)), 1e-6);
  EXPECT_THAT(warnings,
              ::testing::ElementsAre(HasSubstr("10000 positions of 2 other runs of the clock")));
}

TEST(PoseJoiner, CountsPositionsBeforeTheFirstOriginFromIt) {
  // Many positions are joined before the origin is known.
  PoseJoiner joiner;
  joiner.expect(20'000);
  const LocalOrigin origin{47.0, 8.0, 500.0, LocalGrid::kPx4};
  for (int i = 0; i < 20'000; ++i) {
    if (i == 15'000) joiner.local_origin(origin);
    if (i == 18'000) joiner.local_origin({48.0, 8.0, 500.0, LocalGrid::kPx4});
    joiner.attitude({0, i * kNsPerS / 50}, yaw_of(0.0));
    joiner.position({0, i * kNsPerS / 50}, {0.0, 0.0, -10.0});
  }
  std::vector<std::string> warnings;
  const std::vector<LogPose> poses = joiner.take_poses(warnings).poses;
  ASSERT_EQ(poses.size(), 20'000U);
  for (const std::size_t i : {0U, 10'000U, 14'999U, 15'000U, 17'999U}) {
    EXPECT_EQ(poses[i].position, Eigen::Vector3d(47.0, 8.0, 510.0)) << i;
  }
  EXPECT_EQ(poses[18'000].position.x(), 48.0);
  EXPECT_THAT(warnings, ::testing::ElementsAre(HasSubstr("changes 1 times")));
}

}  // namespace
}  // namespace overfly::flight::logs
