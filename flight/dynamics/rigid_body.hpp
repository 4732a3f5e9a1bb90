// Motion of a rigid body over flat earth: kinematics, dynamics, one step of time.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "flight/dynamics/airframe.hpp"

namespace overfly::dynamics {

/// World = east-north-up, body = forward-right-down.
struct BodyState {
  Eigen::Vector3d position_world_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond R_world_body = Eigen::Quaterniond::Identity();  ///< unit
  /// Velocity of body relative to world, expressed in body [m/s].
  Eigen::Vector3d v_body_m_s = Eigen::Vector3d::Zero();
  /// Angular rate of body relative to world, expressed in body [rad/s].
  Eigen::Vector3d omega_body_rad_s = Eigen::Vector3d::Zero();
};

/// Force and moment about the centre of mass, expressed in body.
struct Wrench {
  Eigen::Vector3d force_n = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment_nm = Eigen::Vector3d::Zero();
};

/// Time derivative of a BodyState.
struct BodyMotion {
  Eigen::Vector3d velocity_world_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector4d rotation_1_s = Eigen::Vector4d::Zero();  ///< of the quaternion x, y, z, w
  Eigen::Vector3d acceleration_body_m_s2 = Eigen::Vector3d::Zero();  ///< of v_body_m_s
  Eigen::Vector3d angular_acceleration_rad_s2 = Eigen::Vector3d::Zero();
};

/// Mass and inertia with the inverse that the equations of motion need.
class RigidBody {
 public:
  /// @pre mass and principal moments are positive
  RigidBody(double mass_kg, const Inertia& inertia, double gravity_m_s2);

  /// Newton's and Euler's equations (Beard & McLain, eq. 3.14 to 3.17).
  [[nodiscard]] BodyMotion motion(const BodyState& state, const Wrench& wrench) const;

  /// One step by the classical Runge-Kutta method of order four (Kutta 1901). The quaternion is
  /// normalised after the step; its norm changes within a step by O(dt^5), so the order is kept.
  /// @param wrench_at  Wrench(const BodyState&, double fraction of the step in [0, 1])
  template <typename WrenchAt>
  [[nodiscard]] BodyState step(const BodyState& from,
                               double dt_s,
                               const WrenchAt& wrench_at) const {
    const BodyMotion k1 = motion(from, wrench_at(from, 0.0));
    const BodyState s2 = moved(from, k1, 0.5 * dt_s);
    const BodyMotion k2 = motion(s2, wrench_at(s2, 0.5));
    const BodyState s3 = moved(from, k2, 0.5 * dt_s);
    const BodyMotion k3 = motion(s3, wrench_at(s3, 0.5));
    const BodyState s4 = moved(from, k3, dt_s);
    const BodyMotion k4 = motion(s4, wrench_at(s4, 1.0));
    BodyState to = moved(
        moved(moved(moved(from, k1, dt_s / 6.0), k2, dt_s / 3.0), k3, dt_s / 3.0), k4, dt_s / 6.0);
    to.R_world_body.normalize();
    return to;
  }

  /// Kinetic energy plus potential energy above the world's origin [J].
  [[nodiscard]] double energy_j(const BodyState& state) const;
  /// Angular momentum about the centre of mass, expressed in world [N m s].
  [[nodiscard]] Eigen::Vector3d angular_momentum_world(const BodyState& state) const;

  [[nodiscard]] double mass_kg() const { return mass_kg_; }
  [[nodiscard]] double gravity_m_s2() const { return gravity_m_s2_; }

 private:
  static BodyState moved(const BodyState& from, const BodyMotion& motion, double dt_s);

  double mass_kg_;
  double gravity_m_s2_;
  Eigen::Matrix3d J_;
  Eigen::Matrix3d J_inverse_;
};

}  // namespace overfly::dynamics
