// Gravity and air of the place where an aircraft flies.
#pragma once

#include "core/earth/geodesy.hpp"

namespace overfly::dynamics {

/// Standard gravity [m/s^2] (CGPM 1901).
inline constexpr double kStandardGravityMS2 = 9.80665;

/// Air of the standard atmosphere at a height.
struct StandardAir {
  double temperature_k = 0.0;
  double pressure_pa = 0.0;
  double density_kg_m3 = 0.0;
};

/// Method: U.S. Standard Atmosphere 1976, eq. 18 (geopotential height), 23, 33 and 42: the
/// troposphere to 11 km and the isothermal layer to 20 km. Outside [-5, 20] km the values of the
/// nearer end.
[[nodiscard]] StandardAir standard_air(double alt_msl_m);
/// Density of the standard atmosphere [kg/m^3], as standard_air.
[[nodiscard]] double standard_density_kg_m3(double alt_msl_m);

/// Gravity is one vector for a whole flight: constant along -up of the world frame. Over 1 km of
/// height it changes by 3e-4 of itself, and a constant field keeps the energy of a flight exact.
struct Environment {
  double gravity_m_s2 = kStandardGravityMS2;
  double alt_msl_at_origin_m = 0.0;  ///< height of the world frame's origin above sea level
  double ground_up_m = 0.0;          ///< world; turbulence depends on the height above it

  /// The normal gravity of WGS84 at the world's origin (flight/gravity.hpp).
  [[nodiscard]] static Environment at(const Geodetic& origin, double alt_msl_at_origin_m);
  [[nodiscard]] double density_kg_m3(double up_m) const {
    return standard_density_kg_m3(alt_msl_at_origin_m + up_m);
  }
};

}  // namespace overfly::dynamics
