// What a simulated vehicle reports about itself.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/earth/geodesy.hpp"
#include "flight/autopilot/flight_state.hpp"

namespace overfly::vehicle {

/// Modes of ArduPlane that the vehicle has (custom_mode).
enum class Mode : std::uint32_t {
  kManual = 0,
  kAuto = 10,
  kReturn = 11,
  kLoiter = 12,
  kGuided = 15
};

struct VehicleReport {
  std::int64_t boot_ns = 0;  ///< the vehicle's clock
  Mode mode = Mode::kManual;
  bool armed = false;
  bool in_air = false;
  autopilot::FlightState state;
  LocalFrame frame{Geodetic{}};  ///< heights count as above mean sea level
  double height_above_home_m = 0.0;
  std::int64_t unix_ns = 0;  ///< UTC since 1970; 0: not known
  double throttle = 0.0;
  std::uint16_t mission_item = 0;
  std::uint16_t mission_items = 0;
  Eigen::Vector3d field_ned_ut = Eigen::Vector3d::Zero();  ///< the earth's magnetic field at home
};

}  // namespace overfly::vehicle
