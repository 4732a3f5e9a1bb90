// Guidance along lines and circles, with a point that turns as it is told.
#include "flight/autopilot/path_guidance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "core/motion/pose.hpp"

namespace overfly::autopilot {
namespace {

struct Point {
  Eigen::Vector2d position_m;
  double heading_rad;
  double speed_m_s = 20.0;

  [[nodiscard]] Eigen::Vector2d velocity() const {
    return speed_m_s * Eigen::Vector2d(std::sin(heading_rad), std::cos(heading_rad));
  }
  void step(double acceleration, double dt_s) {
    heading_rad += acceleration / speed_m_s * dt_s;
    position_m += velocity() * dt_s;
  }
};

constexpr double kDt = 0.01;

TEST(PathGuidance, ReturnsToALineWithThePeriodAndDampingAsked) {
  // Small deviations: x'' + 2 zeta omega x' + omega^2 x = 0, starting at 1 m without a rate.
  Parameters p;
  p.navl1_period = 10.0;
  p.navl1_damping = 0.75;
  PathGuidance guidance(p);
  Point point{{1.0, 0.0}, 0.0};
  // The method's natural frequency is sqrt(2) zeta... of the linear law: eta = x / L1 + x' / V.
  const double lead = guidance.lead_m(point.speed_m_s);
  const double gain =
      4.0 * p.navl1_damping * p.navl1_damping * point.speed_m_s * point.speed_m_s / lead;
  const double omega = std::sqrt(gain / lead);
  const double zeta = gain / point.speed_m_s / (2.0 * omega);
  EXPECT_NEAR(omega, 2.0 * kPi / p.navl1_period, 1e-9);
  EXPECT_NEAR(zeta, p.navl1_damping, 1e-9);
  const double damped = omega * std::sqrt(1.0 - zeta * zeta);
  for (int i = 0; i < 2000; ++i) {
    const double t = i * kDt;
    const double expected = std::exp(-zeta * omega * t) *
                            (std::cos(damped * t) + zeta * omega / damped * std::sin(damped * t));
    ASSERT_NEAR(point.position_m.x(), expected, 0.01) << t;
    point.step(guidance.along_line({0, 0}, {0, 1000}, point.position_m, point.velocity()), kDt);
  }
}

TEST(PathGuidance, CapturesALineFromAnywhere) {
  for (const double east : {-800.0, -30.0, 5.0, 700.0}) {
    for (const double heading_deg : {-170.0, -90.0, 0.0, 45.0, 180.0}) {
      PathGuidance guidance(Parameters{});
      Point point{{east, 0.0}, rad_from_deg(heading_deg)};
      for (int i = 0; i < 12000; ++i) {
        const double a = guidance.along_line({0, 0}, {0, 1000}, point.position_m, point.velocity());
        point.step(std::clamp(a, -9.8, 9.8), kDt);
      }
      EXPECT_NEAR(point.position_m.x(), 0.0, 0.05) << east << " " << heading_deg;
      EXPECT_NEAR(wrap_pi(point.heading_rad), 0.0, 1e-3) << east << " " << heading_deg;
    }
  }
}

TEST(PathGuidance, KeepsTheSideOfATurnBackWhenTheAngleIsNoisy) {
  PathGuidance guidance(Parameters{});
  Point point{{0.0, 0.0}, kPi};  // flies away from the line's direction, on the line
  const double first = guidance.along_line({0, 0}, {0, 1000}, {0.01, 0.0}, point.velocity());
  const double second = guidance.along_line({0, 0}, {0, 1000}, {-0.01, 0.0}, point.velocity());
  EXPECT_GT(first * second, 0.0);
}

TEST(PathGuidance, CirclesWithTheRadiusAskedToEitherSide) {
  for (const double radius : {60.0, -80.0}) {
    for (const Eigen::Vector2d& start : {Eigen::Vector2d(-600.0, -700.0),
                                         Eigen::Vector2d(3.0, 2.0),
                                         Eigen::Vector2d(100.0, 0.0)}) {
      PathGuidance guidance(Parameters{});
      Point point{start, 0.3};
      const Eigen::Vector2d centre(10.0, 20.0);
      double turned = 0.0;
      for (int i = 0; i < 20000; ++i) {
        const double a = guidance.around_circle(centre, radius, point.position_m, point.velocity());
        const double before = point.heading_rad;
        point.step(std::clamp(a, -9.8, 9.8), kDt);
        if (i >= 10000) {
          turned += point.heading_rad - before;
          ASSERT_NEAR((point.position_m - centre).norm(), std::abs(radius), 0.3);
        }
      }
      EXPECT_GT(turned * radius, 0.0);  // clockwise is to the right
    }
  }
}

TEST(PathGuidance, FollowsALineInWindAsInCalmAir) {
  PathGuidance guidance(Parameters{});
  Point point{{40.0, 0.0}, 0.0};
  const Eigen::Vector2d wind(-8.0, 3.0);
  for (int i = 0; i < 8000; ++i) {
    const double a =
        guidance.along_line({0, 0}, {0, 1000}, point.position_m, point.velocity() + wind);
    // The acceleration is across the ground velocity; the point turns its air velocity by it.
    point.step(a, kDt);
    point.position_m += wind * kDt;
  }
  EXPECT_NEAR(point.position_m.x(), 0.0, 0.1);
}

}  // namespace
}  // namespace overfly::autopilot
