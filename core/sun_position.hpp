// Where the sun stands, from the time and the place.
#pragma once

#include <cstdint>

#include "core/geodesy.hpp"

namespace overfly {

struct SunPosition {
  double azimuth_rad = 0.0;    ///< clockwise from true north, in [0, 2 pi)
  double elevation_rad = 0.0;  ///< of the disc's middle above the horizon, without air
  /// With the air's refraction: where it is seen, and from where its light comes.
  double apparent_elevation_rad = 0.0;
};

/// What bends the light: the mean air of the almanacs by default.
struct SunAir {
  double pressure_hpa = 1010.0;
  double temperature_c = 10.0;
};

/// The sun's position, good to 0.01 deg from 1950 to 2050.
///
/// Method: Meeus, Astronomical Algorithms (2nd ed., 1998), ch. 25, lower accuracy; sidereal time
/// ch. 12; parallax and refraction after Reda and Andreas (2004), Solar Position Algorithm,
/// doi:10.1016/j.solener.2003.12.003, eq. 42. Below the horizon, where refraction has no meaning
/// for the light on the ground, the apparent elevation goes over into the true one.
/// @param unix_ns  UTC since 1970-01-01 without leap seconds [ns]
[[nodiscard]] SunPosition sun_position(std::int64_t unix_ns,
                                       const Geodetic& place,
                                       const SunAir& air = {});

}  // namespace overfly
