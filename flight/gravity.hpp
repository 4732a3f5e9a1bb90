// Gravity of the reference ellipsoid.
#pragma once

#include "core/earth/geodesy.hpp"

namespace overfly::flight {

/// Normal gravity of WGS84 at a place, including the centrifugal part [m/s^2].
///
/// Method: Somigliana's formula with its upward continuation (NGA.STND.0036 1.0.0, 2014, eq. 4-1
/// and 4-3). Accurate to 5e-7 m/s^2 up to 4 km.
[[nodiscard]] double normal_gravity_m_s2(const Geodetic& place);

}  // namespace overfly::flight
