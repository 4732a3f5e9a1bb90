// Gravity of the reference ellipsoid.
#pragma once

#include "core/geodesy.hpp"

namespace overfly::flight {

/// Normal gravity of WGS84 at a place, centrifugal part included [m/s^2].
///
/// Method: Somigliana's formula and its continuation upwards (NGA.STND.0036 1.0.0, 2014,
/// eq. 4-1 and 4-3). Good to 5e-7 m/s^2 up to 4 km.
[[nodiscard]] double normal_gravity_m_s2(const Geodetic& place);

}  // namespace overfly::flight
