#include "core/earth/sun_position.hpp"

#include <algorithm>
#include <cmath>

#include "core/motion/pose.hpp"

namespace overfly {
namespace {

double sin_deg(double angle_deg) { return std::sin(rad_from_deg(angle_deg)); }
double cos_deg(double angle_deg) { return std::cos(rad_from_deg(angle_deg)); }

/// Terrestrial time less universal time [s]: the fit for 2005 to 2050 of Espenak and Meeus (2006),
/// NASA/TP-2006-214141; a second of error moves the sun by 0.00001 deg.
double delta_t_s(double years_from_2000) {
  const double y = years_from_2000;
  return 62.92 + 0.32217 * y + 0.005589 * y * y;
}

struct Equatorial {
  double right_ascension_rad = 0.0;
  double declination_rad = 0.0;
  double equinoxes_deg = 0.0;  ///< apparent less mean sidereal time
};

/// Meeus ch. 25, "low accuracy". @param t  Julian centuries of terrestrial time from J2000.0
Equatorial apparent_sun(double t) {
  const double mean_longitude_deg = 280.46646 + t * (36000.76983 + t * 0.0003032);  // (25.2)
  const double anomaly_deg = 357.52911 + t * (35999.05029 - t * 0.0001537);         // (25.3)
  const double centre_deg = (1.914602 - t * (0.004817 + t * 0.000014)) * sin_deg(anomaly_deg) +
                            (0.019993 - 0.000101 * t) * sin_deg(2.0 * anomaly_deg) +
                            0.000289 * sin_deg(3.0 * anomaly_deg);
  const double node_deg = 125.04 - 1934.136 * t;
  const double nutation_deg = -0.00478 * sin_deg(node_deg);
  const double longitude_deg = mean_longitude_deg + centre_deg - 0.00569 + nutation_deg;
  const double obliquity_deg = 23.439291111 - t * (0.0130041667 + t * (1.639e-7 - t * 5.036e-7)) +
                               0.00256 * cos_deg(node_deg);  // (22.2), (25.8)
  Equatorial sun;
  sun.right_ascension_rad =
      std::atan2(cos_deg(obliquity_deg) * sin_deg(longitude_deg), cos_deg(longitude_deg));
  sun.declination_rad = std::asin(sin_deg(obliquity_deg) * sin_deg(longitude_deg));
  sun.equinoxes_deg = nutation_deg * cos_deg(obliquity_deg);
  return sun;
}

/// Reda and Andreas 2004, eq. 42 [deg].
double refraction_deg(double elevation_deg, const SunAir& air) {
  constexpr double kLowestDeg = -0.8;  // the upper limb sets at this elevation
  if (elevation_deg <= 3.0 * kLowestDeg) return 0.0;
  const double e = std::max(elevation_deg, kLowestDeg);
  const double bend_deg = air.pressure_hpa / 1010.0 * 283.0 / (273.0 + air.temperature_c) * 1.02 /
                          (60.0 * std::tan(rad_from_deg(e + 10.3 / (e + 5.11))));
  const double share = std::clamp((elevation_deg / kLowestDeg - 1.0) / 2.0, 0.0, 1.0);
  return bend_deg * (1.0 - share);
}

}  // namespace

SunPosition sun_position(std::int64_t unix_ns, const Geodetic& place, const SunAir& air) {
  constexpr double kNsPerDay = 86400e9;
  constexpr double kUnixDaysAtJ2000 = 10957.5;
  const double days = static_cast<double>(unix_ns) / kNsPerDay - kUnixDaysAtJ2000;  // UT
  const double terrestrial_days = days + delta_t_s(days / 365.25) / 86400.0;
  const Equatorial sun = apparent_sun(terrestrial_days / 36525.0);

  const double t = days / 36525.0;
  const double sidereal_deg =
      280.46061837 + 360.98564736629 * days + t * t * 0.000387933 + sun.equinoxes_deg;  // (12.4)
  const double hour_angle_rad =
      rad_from_deg(std::fmod(sidereal_deg, 360.0)) + place.lon_rad - sun.right_ascension_rad;
  const double sin_lat = std::sin(place.lat_rad);
  const double cos_lat = std::cos(place.lat_rad);
  const double sin_declination = std::sin(sun.declination_rad);
  const double cos_declination = std::cos(sun.declination_rad);
  // East, north and up components of the direction to the sun.
  const double east = -cos_declination * std::sin(hour_angle_rad);
  const double north =
      cos_lat * sin_declination - sin_lat * cos_declination * std::cos(hour_angle_rad);
  const double up =
      sin_lat * sin_declination + cos_lat * cos_declination * std::cos(hour_angle_rad);

  SunPosition position;
  position.azimuth_rad = std::atan2(east, north);
  if (position.azimuth_rad < 0.0) position.azimuth_rad += 2.0 * kPi;
  constexpr double kParallaxRad = 8.794 / 3600.0 * kPi / 180.0;
  const double level = std::hypot(east, north);
  position.elevation_rad = std::atan2(up, level) - kParallaxRad * level;
  position.apparent_elevation_rad =
      position.elevation_rad +
      rad_from_deg(refraction_deg(deg_from_rad(position.elevation_rad), air));
  return position;
}

}  // namespace overfly
