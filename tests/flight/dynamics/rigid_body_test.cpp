// The rigid body against closed forms: falls, arcs, free rotation, and the order of the integrator.
#include "flight/dynamics/rigid_body.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/motion/pose.hpp"

namespace overfly::dynamics {
namespace {

constexpr double kG = 9.80665;
constexpr double kStepS = 1.0 / 400.0;

Wrench nothing(const BodyState& /*state*/, double /*fraction*/) { return {}; }

BodyState flown(const RigidBody& body, BodyState state, double duration_s, double dt_s = kStepS) {
  const auto steps = static_cast<int>(std::lround(duration_s / dt_s));
  for (int i = 0; i < steps; ++i) state = body.step(state, dt_s, nothing);
  return state;
}

BodyState thrown() {
  BodyState start;
  start.position_world_m = {3.0, -2.0, 500.0};
  start.R_world_body = R_world_body_from({0.4, -0.2, 2.1});
  start.v_body_m_s = start.R_world_body.conjugate() * Eigen::Vector3d(12.0, -7.0, 15.0);
  return start;
}

Eigen::Quaterniond turned(const Eigen::Vector3d& angle_rad) {
  const double angle = angle_rad.norm();
  if (angle == 0.0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, angle_rad / angle));
}

TEST(RigidBody, FallsAndFliesArcsAsGalileoSays) {
  const RigidBody body(2.0, {0.1, 0.2, 0.25, 0.01}, kG);
  for (const Eigen::Vector3d& spin : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1.0, -2.0, 3.0)}) {
    BodyState start = thrown();
    start.omega_body_rad_s = spin;
    const double t = 5.0;
    const BodyState end = flown(body, start, t);
    const Eigen::Vector3d v0(12.0, -7.0, 15.0);
    const Eigen::Vector3d g(0.0, 0.0, -kG);
    EXPECT_LT((end.position_world_m - (start.position_world_m + t * v0 + 0.5 * t * t * g)).norm(),
              1e-6);
    EXPECT_LT((end.R_world_body * end.v_body_m_s - (v0 + t * g)).norm(), 1e-6);
  }
}

TEST(RigidBody, AxisymmetricTopPrecessesAnalytically) {
  // Symmetric about x, an axis of inertia of an aircraft that spins: A = yy = zz, C = xx.
  const double a = 0.3, c = 0.1;
  const RigidBody body(1.0, {c, a, a, 0.0}, kG);
  BodyState start = thrown();
  start.omega_body_rad_s = {4.0, 1.5, -0.7};
  const Eigen::Vector3d momentum_world = body.angular_momentum_world(start);
  const double body_rate = (c - a) / a * start.omega_body_rad_s.x();
  for (const double t : {0.5, 3.0, 20.0}) {
    const BodyState end = flown(body, start, t);
    // In body the rate turns about x by -(C - A) / A omega_x; in world the axis turns about L.
    const Eigen::Quaterniond spin = turned(Eigen::Vector3d(-body_rate * t, 0.0, 0.0));
    const Eigen::Quaterniond expected =
        turned(momentum_world * (t / a)) * start.R_world_body * spin;
    EXPECT_LT((end.omega_body_rad_s - spin.conjugate() * start.omega_body_rad_s).norm(), 1e-6) << t;
    EXPECT_LT(rotation_angle_rad(end.R_world_body, expected), 1e-6) << t;
  }
}

TEST(RigidBody, TumblingKeepsEnergyMomentumAndNorm) {
  // The inertia of the Aerosonde, about no principal axis and close to the unstable one.
  const RigidBody body(11.0, {0.8244, 1.135, 1.759, 0.1204}, kG);
  for (const Eigen::Vector3d& spin :
       {Eigen::Vector3d(2.0, 3.0, -1.0), Eigen::Vector3d(0.01, 6.0, 0.02)}) {
    BodyState state = thrown();
    state.omega_body_rad_s = spin;
    const double energy_j = body.energy_j(state);
    const Eigen::Vector3d momentum = body.angular_momentum_world(state);
    for (int i = 0; i < 60 * 400; ++i) {
      state = body.step(state, kStepS, nothing);
      ASSERT_NEAR(state.R_world_body.norm(), 1.0, 1e-15);
    }
    EXPECT_NEAR(body.energy_j(state) / energy_j, 1.0, 1e-6);
    EXPECT_LT((body.angular_momentum_world(state) - momentum).norm() / momentum.norm(), 1e-6);
    // It has tumbled: without the coupling of the axes the rate would be what it was.
    EXPECT_GT((state.omega_body_rad_s - spin).norm(), 0.1);
  }
}

TEST(RigidBody, ForcesAndMomentsAccelerate) {
  const Inertia inertia{0.8, 1.1, 1.7, 0.12};
  const RigidBody body(4.0, inertia, 0.0);
  const BodyMotion motion = body.motion({}, {{8.0, -4.0, 2.0}, {0.3, 0.2, -0.4}});
  EXPECT_LT((motion.acceleration_body_m_s2 - Eigen::Vector3d(2.0, -1.0, 0.5)).norm(), 1e-15);
  // xx p' - xz r' = L, zz r' - xz p' = N.
  const Eigen::Vector3d& a = motion.angular_acceleration_rad_s2;
  EXPECT_NEAR(inertia.xx * a.x() - inertia.xz * a.z(), 0.3, 1e-15);
  EXPECT_NEAR(inertia.yy * a.y(), 0.2, 1e-15);
  EXPECT_NEAR(inertia.zz * a.z() - inertia.xz * a.x(), -0.4, 1e-15);
}

TEST(RigidBody, RungeKuttaHasOrderFour) {
  const RigidBody body(11.0, {0.8244, 1.135, 1.759, 0.1204}, kG);
  BodyState start = thrown();
  start.omega_body_rad_s = {2.0, 3.0, -1.0};
  // A force and a moment that follow the motion and the time.
  const auto wrench = [](const BodyState& state, double /*fraction*/) {
    return Wrench{
        -0.3 * state.v_body_m_s.norm() * state.v_body_m_s,
        -0.2 * state.omega_body_rad_s + 0.05 * state.v_body_m_s.cross(Eigen::Vector3d::UnitX())};
  };
  const auto flight = [&](double dt_s) {
    BodyState state = start;
    for (int i = 0; i < static_cast<int>(std::lround(2.0 / dt_s)); ++i) {
      state = body.step(state, dt_s, wrench);
    }
    return state;
  };
  const BodyState exact = flight(1.0 / 3200.0);
  double previous = 0.0;
  for (const double dt_s : {1.0 / 25.0, 1.0 / 50.0, 1.0 / 100.0, 1.0 / 200.0}) {
    const BodyState end = flight(dt_s);
    const double error = (end.position_world_m - exact.position_world_m).norm() +
                         (end.v_body_m_s - exact.v_body_m_s).norm() +
                         rotation_angle_rad(end.R_world_body, exact.R_world_body) +
                         (end.omega_body_rad_s - exact.omega_body_rad_s).norm();
    if (previous > 0.0) {
      const double order = std::log2(previous / error);
      EXPECT_GT(order, 3.8) << dt_s;
      EXPECT_LT(order, 4.3) << dt_s;
    }
    previous = error;
  }
}

TEST(RigidBody, FollowsTheFractionOfTheStep) {
  // A force that grows linearly in time: x = t^3 / 6 exactly, which order four integrates exactly.
  const RigidBody body(1.0, {1.0, 1.0, 1.0, 0.0}, 0.0);
  BodyState state;
  const double dt_s = 0.1;
  for (int i = 0; i < 20; ++i) {
    state = body.step(state, dt_s, [&](const BodyState& /*at*/, double fraction) {
      return Wrench{{dt_s * (i + fraction), 0.0, 0.0}, Eigen::Vector3d::Zero()};
    });
  }
  // Body x is the world's east with the identity.
  EXPECT_NEAR(state.position_world_m.x(), 8.0 / 6.0, 1e-13);
}

}  // namespace
}  // namespace overfly::dynamics
