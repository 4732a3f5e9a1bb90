#include "flight/gravity.hpp"

#include <cmath>

namespace overfly::flight {

double normal_gravity_m_s2(const Geodetic& place) {
  // Derived constants of WGS84 (NGA.STND.0036, table 3.6 and 3.7).
  constexpr double kEquatorial = 9.7803253359;
  constexpr double kSomigliana = 1.931852652458e-3;
  constexpr double kEccentricity2 = 6.694379990141e-3;
  constexpr double kFlattening = 1.0 / 298.257223563;
  constexpr double kSemiMajorM = 6378137.0;
  constexpr double kM = 3.449786506841e-3;  // omega^2 a^2 b / GM
  const double s2 = std::sin(place.lat_rad) * std::sin(place.lat_rad);
  const double at_ellipsoid =
      kEquatorial * (1.0 + kSomigliana * s2) / std::sqrt(1.0 - kEccentricity2 * s2);
  const double h = place.alt_ellipsoid_m / kSemiMajorM;
  return at_ellipsoid *
         (1.0 - 2.0 * (1.0 + kFlattening + kM - 2.0 * kFlattening * s2) * h + 3.0 * h * h);
}

}  // namespace overfly::flight
