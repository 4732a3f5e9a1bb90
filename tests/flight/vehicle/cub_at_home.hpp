// The vehicle of the tests.
#pragma once

#include "core/motion/pose.hpp"
#include "flight/vehicle/simulated_vehicle.hpp"
#include "tests/flight/dynamics/airframes.hpp"

namespace overfly::vehicle {

/// A 1/3-scale Cub on the runway of the built-in world.
inline VehicleSetup cub_at_home() {
  VehicleSetup setup;
  setup.airframe = dynamics::testing::airframe("piper_cub_third");
  setup.airspeed_m_s = 20.0;
  setup.home = geodetic_from_deg(39.355375, -86.030728, 227.7);
  setup.heading_rad = kPi;
  setup.seed = 3;
  return setup;
}

}  // namespace overfly::vehicle
