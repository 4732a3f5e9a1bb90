#include "flight/height_profile.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/motion/pose.hpp"
#include "flight/flight.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight {
namespace {

using overfly::testing::larger_error;
using ::testing::HasSubstr;

constexpr double kSpeedMS = 25.0;
constexpr double kDurationS = 200.0;
const HeightLimits kLimits{.knot_s = kHeightKnotM / kSpeedMS, .climb_max_m_s = 3.5};

HeightProfile above(const std::function<double(double)>& ground) {
  return HeightProfile::above(ground, 300.0, kDurationS, kLimits).value();
}

/// How much of a ground wave of this length the profile takes: its amplitude over the wave's.
double taken_of_wave(double wavelength_m) {
  const double omega = 2.0 * kPi * kSpeedMS / wavelength_m;
  const HeightProfile profile = above([&](double t_s) { return std::sin(omega * t_s); });
  double largest = 0.0;
  for (double t_s = 20.0; t_s < kDurationS - 20.0; t_s += 0.01) {
    largest = larger_error(largest, std::abs(profile.at(t_s).up_m - 300.0));
  }
  return largest;
}

TEST(HeightProfile, FollowsLongHillsAndIgnoresBumpsAsStated) {
  EXPECT_GT(taken_of_wave(800.0), 0.96);
  EXPECT_GT(taken_of_wave(2000.0), 0.99);
  for (const double wavelength_m : {79.0, 70.0, 61.0, 52.0, 43.0, 40.0, 23.0, 17.0}) {
    EXPECT_LT(taken_of_wave(wavelength_m), 0.06) << wavelength_m;
  }
}

TEST(HeightProfile, HasNoLag) {
  const double omega = 2.0 * kPi * kSpeedMS / 800.0;
  const HeightProfile profile = above([&](double t_s) { return 10.0 * std::sin(omega * t_s); });
  // At the crossings of the ground's wave the profile crosses too; 1 % of the slope is 0.3 m.
  for (int k = 1; k < 10; ++k) EXPECT_NEAR(profile.at(k * kPi / omega).up_m, 300.0, 0.02) << k;
}

TEST(HeightProfile, KeepsASlopeExactlyAndItsDerivativesAgree) {
  const HeightProfile slope = above([](double t_s) { return 1.5 * t_s; });
  EXPECT_NEAR(slope.at(100.0).up_m, 450.0, 1e-9);
  EXPECT_NEAR(slope.at(100.0).climb_m_s, 1.5, 1e-9);
  EXPECT_NEAR(slope.at(100.0).climb_rate_m_s2, 0.0, 1e-9);

  const HeightProfile hills = above([](double t_s) { return 20.0 * std::sin(0.11 * t_s); });
  for (double t_s = 1.0; t_s < 199.0; t_s += 0.37) {
    const double h = 1e-4;
    const double climb = (hills.at(t_s + h).up_m - hills.at(t_s - h).up_m) / (2 * h);
    const double rate = (hills.at(t_s + h).climb_m_s - hills.at(t_s - h).climb_m_s) / (2 * h);
    ASSERT_NEAR(hills.at(t_s).climb_m_s, climb, 1e-7);
    ASSERT_NEAR(hills.at(t_s).climb_rate_m_s2, rate, 1e-7);
  }
}

TEST(HeightProfile, RefusesGroundTooSteepToFollow) {
  const auto endless = [](double t_s) { return 10.0 * t_s; };
  const auto profile = HeightProfile::above(endless, 300.0, kDurationS, kLimits);
  ASSERT_FALSE(profile.ok());
  EXPECT_EQ(profile.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(profile.error().message, HasSubstr("too steep"));
}

}  // namespace
}  // namespace overfly::flight
