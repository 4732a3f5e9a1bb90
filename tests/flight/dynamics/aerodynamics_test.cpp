// Aerodynamic forces and the propeller: the book's equations, and every attitude and speed.
#include "flight/dynamics/aerodynamics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/motion/pose.hpp"
#include "tests/flight/dynamics/airframes.hpp"

namespace overfly::dynamics {
namespace {

constexpr double kDensity = 1.2;

TEST(LiftDrag, IsTheBooksBelowAndAboveTheStall) {
  const Airframe a = testing::airframe("aerosonde");
  for (const double alpha : {-0.1, 0.0, 0.05, 0.2}) {
    const double lift = a.lift.zero + a.lift.alpha * alpha;
    // The blend leaves 50 (0.2 - 0.471): 1.3e-6 of the difference to the plate.
    EXPECT_NEAR(lift_drag(a, alpha).lift, lift, 3e-6);
    EXPECT_NEAR(lift_drag(a, alpha).drag,
                a.drag.parasite + lift * lift / (kPi * a.drag.oswald * a.aspect_ratio()),
                3e-6);
  }
  for (const double alpha : {-2.5, -1.0, 1.0, 1.5707, 2.5}) {
    const double sine = std::sin(alpha);
    const double sign = alpha > 0.0 ? 1.0 : -1.0;
    EXPECT_NEAR(lift_drag(a, alpha).lift, 2.0 * sign * sine * sine * std::cos(alpha), 1e-6);
    EXPECT_NEAR(
        lift_drag(a, alpha).drag - a.drag.parasite, 2.0 * std::abs(sine * sine * sine), 1e-6);
  }
  // The middle of the blend, eq. 4.9 with one half each.
  const double alpha = a.stall.alpha_rad;
  const double plate = 2.0 * std::pow(std::sin(alpha), 2) * std::cos(alpha);
  EXPECT_NEAR(
      lift_drag(a, alpha).lift, 0.5 * (a.lift.zero + a.lift.alpha * alpha) + 0.5 * plate, 1e-9);
}

TEST(LiftDrag, SharpStallsDoNotOverflow) {
  Airframe a = testing::airframe("aerosonde");
  a.stall.sharpness = 500.0;
  for (double alpha = -kPi; alpha <= kPi; alpha += 0.001) {
    EXPECT_TRUE(std::isfinite(lift_drag(a, alpha).lift));
    EXPECT_GT(lift_drag(a, alpha).drag, 0.0);
  }
}

TEST(Aerodynamics, AreTheBooksForSmallAngles) {
  const Airframe a = testing::airframe("aerosonde");
  const double alpha = 0.06, beta = 0.001, speed = 25.0;
  const Eigen::Vector3d v(speed * std::cos(alpha) * std::cos(beta),
                          speed * std::sin(beta),
                          speed * std::sin(alpha) * std::cos(beta));
  const Eigen::Vector3d omega(0.1, -0.2, 0.3);
  const Controls at{-0.05, 0.02, 0.03, 0.0};
  const Wrench wrench = aerodynamic_wrench(a, v, omega, at, kDensity);
  // Eq. 4.18 to 4.20.
  const double pressure = 0.5 * kDensity * speed * speed * a.wing.area_m2;
  const double per_span = a.wing.span_m / (2.0 * speed);
  const double per_chord = a.wing.chord_m / (2.0 * speed);
  const double lift =
      pressure * (lift_drag(a, alpha).lift + a.lift.pitch_rate * per_chord * omega.y() +
                  a.lift.elevator * at.elevator_rad);
  const double drag = pressure * (lift_drag(a, alpha).drag + a.drag.elevator * 0.05);
  const auto lateral = [&](const LateralCoefficients& c) {
    return pressure *
           (c.beta * beta + c.roll_rate * per_span * omega.x() + c.yaw_rate * per_span * omega.z() +
            c.aileron * at.aileron_rad + c.rudder * at.rudder_rad);
  };
  const double pitch =
      pressure * a.wing.chord_m *
      (a.pitch.zero + a.pitch.alpha * alpha + a.pitch.pitch_rate * per_chord * omega.y() +
       a.pitch.elevator * at.elevator_rad);
  // cos^2(beta) differs from 1 by 1e-6, the blend by 1e-9.
  EXPECT_NEAR(wrench.force_n.x(), -drag * std::cos(alpha) + lift * std::sin(alpha), 3e-4);
  EXPECT_NEAR(wrench.force_n.z(), -drag * std::sin(alpha) - lift * std::cos(alpha), 3e-4);
  EXPECT_NEAR(wrench.force_n.y(), lateral(a.side), 1e-4);
  EXPECT_NEAR(wrench.moment_nm.x(), a.wing.span_m * lateral(a.roll), 1e-4);
  EXPECT_NEAR(wrench.moment_nm.y(), pitch, 1e-4);
  EXPECT_NEAR(wrench.moment_nm.z(), a.wing.span_m * lateral(a.yaw), 1e-4);
}

TEST(Aerodynamics, TakeEnergyFromEveryTranslationAndAreContinuous) {
  std::mt19937_64 generator(7);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(generator() >> 11U) * 0x1.0p-53;
  };
  for (const char* name : testing::kAirframes) {
    const Airframe a = testing::airframe(name);
    for (int i = 0; i < 20000; ++i) {
      const Eigen::Vector3d v(uniform(-60, 60), uniform(-60, 60), uniform(-60, 60));
      const Wrench still = aerodynamic_wrench(a, v, Eigen::Vector3d::Zero(), {}, kDensity);
      ASSERT_TRUE(still.force_n.allFinite() && still.moment_nm.allFinite());
      EXPECT_LT(still.force_n.dot(v), 0.0);
      const Eigen::Vector3d near = v + Eigen::Vector3d(1e-7, -1e-7, 1e-7);
      const Wrench beside = aerodynamic_wrench(a, near, Eigen::Vector3d::Zero(), {}, kDensity);
      // Slopes are below 1e5 N s/m even in the stall.
      EXPECT_LT((beside.force_n - still.force_n).norm(), 0.03);
      EXPECT_LT((beside.moment_nm - still.moment_nm).norm(), 0.03);
      // Rotation alone is damped: the moment of the rates does negative work.
      const Eigen::Vector3d omega(uniform(-5, 5), uniform(-5, 5), uniform(-5, 5));
      const Wrench turning = aerodynamic_wrench(a, v, omega, {}, kDensity);
      EXPECT_LE((turning.moment_nm - still.moment_nm).dot(omega), 0.0);
    }
  }
}

TEST(Aerodynamics, EdgesOfTheModelAreFinite) {
  const Airframe a = testing::airframe("foam_trainer");
  const Controls full{-0.4, 0.4, 0.4, 1.0};
  for (const Eigen::Vector3d& v : std::vector<Eigen::Vector3d>{{0, 0, 0},
                                                               {-20, 0, 0},
                                                               {-20, 0, -1e-12},
                                                               {0, 20, 0},
                                                               {0, 0, 20},
                                                               {0, 0, -20},
                                                               {1e-300, 0, 0},
                                                               {300, 300, 300}}) {
    const Wrench wrench = air_wrench(a, v, {30.0, -30.0, 30.0}, full, kDensity);
    EXPECT_TRUE(wrench.force_n.allFinite() && wrench.moment_nm.allFinite()) << v.transpose();
  }
  // Falling tail first, the drag points forward and the tail comes round to either side.
  const auto back = aerodynamic_wrench(a, {-20.0, 0.5, 0.5}, Eigen::Vector3d::Zero(), {}, kDensity);
  EXPECT_GT(back.force_n.x(), 0.0);
  EXPECT_LT(back.moment_nm.y(), 0.0);  // the wind comes from below: nose down, towards it
  EXPECT_GT(back.moment_nm.z(), 0.0);  // and from the right: nose right
  // At rest only the propeller acts.
  const auto rest = air_wrench(a, {0, 0, 0}, {1.0, 1.0, 1.0}, full, kDensity);
  EXPECT_GT(rest.force_n.x(), 5.0);
  // Its reaction rolls to the left: it turns clockwise seen from behind.
  EXPECT_EQ(rest.moment_nm.x(), -propeller(a.propulsion, 0.0, 1.0, kDensity).torque_nm);
  EXPECT_LT(rest.moment_nm.x(), 0.0);
  EXPECT_EQ(rest.force_n.y(), 0.0);
  EXPECT_EQ(rest.force_n.z(), 0.0);
}

TEST(Aerodynamics, MirrorTheirImage) {
  const Airframe a = testing::airframe("piper_cub_third");
  const Wrench right =
      aerodynamic_wrench(a, {20.0, 3.0, 2.0}, {0.3, 0.2, -0.1}, {0.1, 0.2, -0.1, 0.0}, kDensity);
  const Wrench left =
      aerodynamic_wrench(a, {20.0, -3.0, 2.0}, {-0.3, 0.2, 0.1}, {0.1, -0.2, 0.1, 0.0}, kDensity);
  EXPECT_EQ(right.force_n.x(), left.force_n.x());
  EXPECT_EQ(right.force_n.y(), -left.force_n.y());
  EXPECT_EQ(right.force_n.z(), left.force_n.z());
  EXPECT_EQ(right.moment_nm.x(), -left.moment_nm.x());
  EXPECT_EQ(right.moment_nm.y(), left.moment_nm.y());
  EXPECT_EQ(right.moment_nm.z(), -left.moment_nm.z());
}

TEST(Propeller, BalancesTheTorqueOfItsMotor) {
  const Propulsion p = testing::airframe("aerosonde").propulsion;
  for (const double speed : {0.0, 10.0, 25.0, 35.0}) {
    for (const double throttle : {0.3, 0.7, 1.0}) {
      const PropellerState state = propeller(p, speed, throttle, kDensity);
      const double current =
          (throttle * p.battery_v - p.motor_constant_v_s_rad * state.speed_rad_s) /
          p.motor_resistance_ohm;
      EXPECT_NEAR(state.torque_nm,
                  p.motor_constant_v_s_rad * (current - p.no_load_current_a),
                  1e-9 * std::abs(state.torque_nm) + 1e-9);
      // Thrust by its definition, rho n^2 D^4 C_T(J).
      const double n = state.speed_rad_s / (2.0 * kPi);
      const double j = speed / (n * p.diameter_m);
      const double coefficient = p.thrust.zero + p.thrust.linear * j + p.thrust.quadratic * j * j;
      EXPECT_NEAR(state.thrust_n, kDensity * n * n * std::pow(p.diameter_m, 4) * coefficient, 1e-9);
    }
  }
}

TEST(Propeller, WithoutPowerBrakesInEveryFlow) {
  for (const char* name : testing::kAirframes) {
    const Propulsion p = testing::airframe(name).propulsion;
    for (double speed = -80.0; speed <= 80.0; speed += 0.5) {
      const PropellerState state = propeller(p, speed, 0.0, kDensity);
      EXPECT_GE(state.speed_rad_s, 0.0);
      EXPECT_LE(state.thrust_n * speed, 0.0) << name << ' ' << speed;
    }
    EXPECT_EQ(propeller(p, 0.0, 0.0, kDensity).thrust_n, 0.0);
    EXPECT_GT(propeller(p, -20.0, 1.0, kDensity).thrust_n,
              propeller(p, 0.0, 1.0, kDensity).thrust_n);
  }
}

}  // namespace
}  // namespace overfly::dynamics
