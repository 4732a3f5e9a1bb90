// Actuators against the solution of their differential equation.
#include "flight/dynamics/actuators.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/motion/pose.hpp"
#include "tests/flight/dynamics/airframes.hpp"

namespace overfly::dynamics {
namespace {

TEST(Actuators, SmallCommandsFollowTheLag) {
  const Airframe airframe = testing::airframe("aerosonde");
  // 0.1 rad over 0.05 s is 2 rad/s, below the rate limit of 5.2.
  const Controls end = advance({}, {0.1, -0.1, 0.1, 0.2}, airframe, 0.08);
  const double reached = 1.0 - std::exp(-0.08 / 0.05);
  EXPECT_NEAR(end.elevator_rad, 0.1 * reached, 1e-15);
  EXPECT_NEAR(end.aileron_rad, -0.1 * reached, 1e-15);
  EXPECT_NEAR(end.rudder_rad, 0.1 * reached, 1e-15);
  EXPECT_NEAR(end.throttle, 0.2 * (1.0 - std::exp(-0.08 / 0.2)), 1e-15);
}

TEST(Actuators, AgreeWithSmallStepsThroughTheRateLimit) {
  const Airframe airframe = testing::airframe("piper_cub_third");
  const Controls start{0.4, -0.3, 0.0, 1.0};
  const Controls command{-0.4, 0.4, 9.0, 0.0};
  Controls euler = start;
  const int steps = 400000;
  const double dt_s = 0.2 / steps;
  const auto moved = [&](double x, double c, const SurfaceLimits& limits) {
    const double target = std::clamp(c, limits.min_rad, limits.max_rad);
    const double rate =
        std::clamp((target - x) / limits.lag_s, -limits.rate_rad_s, limits.rate_rad_s);
    return x + dt_s * rate;
  };
  for (int i = 0; i < steps; ++i) {
    euler.elevator_rad = moved(euler.elevator_rad, command.elevator_rad, airframe.elevator);
    euler.aileron_rad = moved(euler.aileron_rad, command.aileron_rad, airframe.aileron);
    euler.rudder_rad = moved(euler.rudder_rad, command.rudder_rad, airframe.rudder);
    euler.throttle = moved(euler.throttle,
                           command.throttle,
                           {0.0, 1.0, airframe.throttle.rate_1_s, airframe.throttle.lag_s});
  }
  const Controls once = advance(start, command, airframe, 0.2);
  Controls parts = start;
  for (int i = 0; i < 7; ++i) parts = advance(parts, command, airframe, 0.2 / 7.0);
  for (const Controls& end : {once, parts}) {
    EXPECT_NEAR(end.elevator_rad, euler.elevator_rad, 1e-5);
    EXPECT_NEAR(end.aileron_rad, euler.aileron_rad, 1e-5);
    EXPECT_NEAR(end.rudder_rad, euler.rudder_rad, 1e-5);
    EXPECT_NEAR(end.throttle, euler.throttle, 1e-5);
  }
  EXPECT_NEAR(once.elevator_rad, parts.elevator_rad, 1e-14);
}

TEST(Actuators, NeverLeaveTheirRange) {
  const Airframe airframe = testing::airframe("foam_trainer");
  const double infinity = std::numeric_limits<double>::infinity();
  Controls at;
  for (int i = 0; i < 400; ++i) at = advance(at, {infinity, -infinity, 1e300, 7.0}, airframe, 0.01);
  EXPECT_NEAR(at.elevator_rad, rad_from_deg(25.0), 1e-12);
  EXPECT_NEAR(at.aileron_rad, rad_from_deg(-25.0), 1e-12);
  EXPECT_NEAR(at.rudder_rad, rad_from_deg(25.0), 1e-12);
  EXPECT_NEAR(at.throttle, 1.0, 1e-12);
  const double nan = std::nan("");
  const Controls held = advance(at, {nan, nan, nan, nan}, airframe, 1.0);
  EXPECT_EQ(held.elevator_rad, at.elevator_rad);
  EXPECT_EQ(held.throttle, at.throttle);
  EXPECT_EQ(limited({nan, 9.0, -9.0, 2.0}, airframe).throttle, 1.0);
  EXPECT_EQ(limited({nan, 9.0, -9.0, 2.0}, airframe).elevator_rad, 0.0);
}

}  // namespace
}  // namespace overfly::dynamics
