// The table of parameters, and those derived from an airframe.
#include "flight/autopilot/parameters.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "flight/autopilot/smooth_ground.hpp"
#include "tests/flight/dynamics/airframes.hpp"

namespace overfly::autopilot {
namespace {

using ::testing::HasSubstr;

TEST(Parameters, AreListedByName) {
  const auto table = parameter_table();
  EXPECT_TRUE(std::is_sorted(table.begin(), table.end(), [](const auto& a, const auto& b) {
    return std::string(a.name) < b.name;
  }));
  // MAVLink's names have 16 bytes.
  for (const ParameterInfo& info : table)
    EXPECT_LE(std::string(info.name).size(), 16u) << info.name;
  // Every member is in the table: the structure holds nothing else.
  EXPECT_EQ(table.size(), sizeof(Parameters) / sizeof(double));
}

TEST(Parameters, AreCheckedAgainstTheirLimits) {
  Parameters parameters;
  for (const ParameterInfo& info : parameter_table()) {
    EXPECT_TRUE(set_parameter(parameters, info.name, info.maximum).ok()) << info.name;
    EXPECT_EQ(parameters.*info.value, info.maximum);
    EXPECT_THAT(set_parameter(parameters, info.name, info.minimum - 1.0).error().message,
                HasSubstr(info.name));
    EXPECT_FALSE(set_parameter(parameters, info.name, std::nan("")).ok());
  }
  EXPECT_FALSE(set_parameter(parameters, "rll2srv_rmax", 45.0).ok());
  EXPECT_TRUE(check(Parameters{}).ok());
}

TEST(Parameters, NameNoCircleWithoutARadius) {
  Parameters parameters;
  for (const double radius_m : {0.0, 0.9, -0.5}) {
    const Status status = set_parameter(parameters, "WP_LOITER_RAD", radius_m);
    ASSERT_FALSE(status.ok()) << radius_m;
    EXPECT_THAT(status.error().message, HasSubstr("must be in [-10000, -1] or [1, 10000]"));
    Parameters odd;
    odd.wp_loiter_rad = radius_m;
    EXPECT_FALSE(check(odd).ok());
  }
  EXPECT_TRUE(set_parameter(parameters, "WP_LOITER_RAD", -1.0).ok());
}

TEST(Parameters, AreTunedForEveryAirframe) {
  for (const char* name : dynamics::testing::kAirframes) {
    const double cruise = dynamics::testing::cruise_m_s(name);
    const auto tuned = tuned_for(dynamics::testing::airframe(name), {}, cruise, 0.0);
    ASSERT_TRUE(tuned.ok()) << name << ": " << tuned.error().message;
    EXPECT_GT(tuned->rll_rate_ff, 0.0);
    EXPECT_GT(tuned->ptch_rate_ff, 0.0);
    EXPECT_GT(tuned->tecs_clmb_max, 1.0);
    EXPECT_LT(tuned->airspeed_min, cruise);
  }
}

class Plane final : public HeightQuery {
 public:
  [[nodiscard]] double ground_up_m(double east_m, double north_m) const override {
    return 5.0 + 0.1 * east_m - 0.2 * north_m;
  }
};

class Wave final : public HeightQuery {
 public:
  explicit Wave(double period_m) : period_m_(period_m) {}
  [[nodiscard]] double ground_up_m(double east_m, double /*north_m*/) const override {
    return std::cos(2.0 * kPi * east_m / period_m_);
  }

 private:
  double period_m_;
};

TEST(SmoothGround, KeepsPlanesAndLongWavesOnly) {
  SmoothGround plane(std::make_shared<Plane>(), 40.0);
  for (const auto& at : {Eigen::Vector2d(3.0, 7.0), Eigen::Vector2d(-513.2, 88.1)}) {
    EXPECT_NEAR(plane.up_m(at), Plane().ground_up_m(at.x(), at.y()), 1e-9);
  }
  const auto kept = [](double spacings) {
    constexpr double kSpacing = 40.0;
    SmoothGround wave(std::make_shared<Wave>(spacings * kSpacing), kSpacing);
    double largest = 0.0;
    for (double east = 0.0; east < spacings * kSpacing; east += 1.0) {
      largest = std::max(largest, std::abs(wave.up_m({east, 0.0})));
    }
    return largest;
  };
  EXPECT_NEAR(kept(10.0), 0.92, 0.03);
  EXPECT_LT(kept(2.0), 0.25);
  EXPECT_TRUE(std::isnan(plane.up_m({std::nan(""), 0.0})));
}

}  // namespace
}  // namespace overfly::autopilot
