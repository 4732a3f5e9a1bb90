// The sun's position for a time and place.
#pragma once

#include <cstdint>

#include "core/earth/geodesy.hpp"

namespace overfly {

struct SunPosition {
  double azimuth_rad = 0.0;    ///< clockwise from true north, in [0, 2 pi)
  double elevation_rad = 0.0;  ///< of the disc's centre, without refraction
  /// Elevation with atmospheric refraction: where the sun is seen and where its light comes from.
  double apparent_elevation_rad = 0.0;
};

/// Air for the refraction. The defaults are the standard values of the almanacs.
struct SunAir {
  double pressure_hpa = 1010.0;
  double temperature_c = 10.0;
};

/// The sun's position, accurate to 0.01 deg from 1950 to 2050.
///
/// Method: Meeus, Astronomical Algorithms (2nd ed., 1998), ch. 25, lower accuracy; sidereal time
/// ch. 12; parallax and refraction after Reda and Andreas (2004), Solar Position Algorithm,
/// doi:10.1016/j.solener.2003.12.003, eq. 42. Below the horizon the apparent elevation blends into
/// the true one, because refraction has no effect on the light on the ground there.
/// @param unix_ns  UTC since 1970-01-01 without leap seconds [ns]
[[nodiscard]] SunPosition sun_position(std::int64_t unix_ns,
                                       const Geodetic& place,
                                       const SunAir& air = {});

}  // namespace overfly
