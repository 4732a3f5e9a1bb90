#include "flight/dynamics/rigid_body.hpp"

#include <Eigen/LU>

namespace overfly::dynamics {

RigidBody::RigidBody(double mass_kg, const Inertia& inertia, double gravity_m_s2)
    : mass_kg_(mass_kg), gravity_m_s2_(gravity_m_s2) {
  J_ << inertia.xx, 0.0, -inertia.xz, 0.0, inertia.yy, 0.0, -inertia.xz, 0.0, inertia.zz;
  J_inverse_ = J_.inverse();
}

BodyMotion RigidBody::motion(const BodyState& state, const Wrench& wrench) const {
  const Eigen::Matrix3d R = state.R_world_body.toRotationMatrix();
  const Eigen::Vector3d& v = state.v_body_m_s;
  const Eigen::Vector3d& omega = state.omega_body_rad_s;
  BodyMotion motion;
  motion.velocity_world_m_s = R * v;
  // Gravity along -up: minus the third row of R.
  motion.acceleration_body_m_s2 =
      wrench.force_n * (1.0 / mass_kg_) - gravity_m_s2_ * R.row(2).transpose() - omega.cross(v);
  motion.angular_acceleration_rad_s2 = J_inverse_ * (wrench.moment_nm - omega.cross(J_ * omega));
  const Eigen::Quaterniond rate(0.0, 0.5 * omega.x(), 0.5 * omega.y(), 0.5 * omega.z());
  motion.rotation_1_s = (state.R_world_body * rate).coeffs();
  return motion;
}

BodyState RigidBody::moved(const BodyState& from, const BodyMotion& motion, double dt_s) {
  BodyState to;
  to.position_world_m = from.position_world_m + dt_s * motion.velocity_world_m_s;
  to.R_world_body.coeffs() = from.R_world_body.coeffs() + dt_s * motion.rotation_1_s;
  to.v_body_m_s = from.v_body_m_s + dt_s * motion.acceleration_body_m_s2;
  to.omega_body_rad_s = from.omega_body_rad_s + dt_s * motion.angular_acceleration_rad_s2;
  return to;
}

double RigidBody::energy_j(const BodyState& state) const {
  return 0.5 * mass_kg_ * state.v_body_m_s.squaredNorm() +
         0.5 * state.omega_body_rad_s.dot(J_ * state.omega_body_rad_s) +
         mass_kg_ * gravity_m_s2_ * state.position_world_m.z();
}

Eigen::Vector3d RigidBody::angular_momentum_world(const BodyState& state) const {
  return state.R_world_body * (J_ * state.omega_body_rad_s);
}

}  // namespace overfly::dynamics
