// Accelerations of an aircraft in still air as a function of flight angles. Private to dynamics:
// the common ground of trim and linear models.
#pragma once

#include <Eigen/Core>

#include "flight/dynamics/actuators.hpp"
#include "flight/dynamics/airframe.hpp"

namespace overfly::dynamics {

/// Velocity and rate in body, and the two angles that gravity depends on.
struct FlightPoint {
  Eigen::Vector3d v_body_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d omega_body_rad_s = Eigen::Vector3d::Zero();
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  Controls controls;
};

/// Time derivatives of a FlightPoint, and the air's side force per mass.
struct FlightPointMotion {
  Eigen::Vector3d acceleration_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_acceleration_rad_s2 = Eigen::Vector3d::Zero();
  double roll_rate_rad_s = 0.0;  ///< of the roll angle
  double pitch_rate_rad_s = 0.0;
  double side_force_m_s2 = 0.0;
};

[[nodiscard]] FlightPointMotion motion_at(const Airframe& airframe,
                                          double gravity_m_s2,
                                          double density_kg_m3,
                                          const FlightPoint& point);

}  // namespace overfly::dynamics
