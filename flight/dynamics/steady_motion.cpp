#include "flight/dynamics/steady_motion.hpp"

#include <cmath>

#include "core/motion/pose.hpp"
#include "flight/dynamics/aerodynamics.hpp"
#include "flight/dynamics/rigid_body.hpp"

namespace overfly::dynamics {

FlightPointMotion motion_at(const Airframe& airframe,
                            double gravity_m_s2,
                            double density_kg_m3,
                            const FlightPoint& point) {
  const RigidBody body(airframe.mass_kg, airframe.inertia, gravity_m_s2);
  BodyState state;
  state.R_world_body = R_world_body_from({point.roll_rad, point.pitch_rad, 0.0});
  state.v_body_m_s = point.v_body_m_s;
  state.omega_body_rad_s = point.omega_body_rad_s;
  const Wrench wrench =
      air_wrench(airframe, point.v_body_m_s, point.omega_body_rad_s, point.controls, density_kg_m3);
  const BodyMotion motion = body.motion(state, wrench);
  const Eigen::Vector3d& omega = point.omega_body_rad_s;
  const double sine = std::sin(point.roll_rad);
  const double cosine = std::cos(point.roll_rad);
  FlightPointMotion result;
  result.acceleration_m_s2 = motion.acceleration_body_m_s2;
  result.angular_acceleration_rad_s2 = motion.angular_acceleration_rad_s2;
  // Beard & McLain, eq. 3.3.
  result.roll_rate_rad_s =
      omega.x() + std::tan(point.pitch_rad) * (sine * omega.y() + cosine * omega.z());
  result.pitch_rate_rad_s = cosine * omega.y() - sine * omega.z();
  result.side_force_m_s2 = wrench.force_n.y() / airframe.mass_kg;
  return result;
}

}  // namespace overfly::dynamics
