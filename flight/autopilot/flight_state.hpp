// What the autopilot knows of the flight: the aircraft's state without errors.
#pragma once

#include <Eigen/Core>

#include "core/motion/pose.hpp"
#include "flight/dynamics/aircraft.hpp"

namespace overfly::autopilot {

struct FlightState {
  Eigen::Vector3d position_world_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_world_m_s = Eigen::Vector3d::Zero();
  RollPitchYaw attitude;
  Eigen::Vector3d omega_body_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force_body_m_s2 = Eigen::Vector3d::Zero();
  double airspeed_m_s = 0.0;
  double alpha_rad = 0.0;  ///< angle of attack
  double gravity_m_s2 = 0.0;
};

[[nodiscard]] FlightState flight_state(const dynamics::Aircraft& aircraft);

}  // namespace overfly::autopilot
