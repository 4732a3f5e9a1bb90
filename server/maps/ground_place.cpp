#include "server/maps/ground_place.hpp"

#include <cmath>

namespace overfly::server {

GroundPlace ground_at(const terrain::TileSource& tiles, const Geodetic& place) {
  const LocalFrame& frame = tiles.frame();
  // Each round reduces the error by the inclination of the normal, below 0.02 for 100 km, times
  // the ground's slope.
  constexpr int kRounds = 4;
  constexpr double kCloseM = 1e-3;
  GroundPlace found;
  found.alt_ellipsoid_m = place.alt_ellipsoid_m;
  for (int i = 0; i < kRounds; ++i) {
    const Eigen::Vector3d guess =
        frame.world_from_geodetic({place.lat_rad, place.lon_rad, found.alt_ellipsoid_m});
    found.map_m = tiles.map_from_world(guess.x(), guess.y());
    found.world_m = tiles.world_from_map(found.map_m.x(), found.map_m.y());
    const double before_m = found.alt_ellipsoid_m;
    found.alt_ellipsoid_m = frame.geodetic_from_world(found.world_m).alt_ellipsoid_m;
    if (std::abs(found.alt_ellipsoid_m - before_m) < kCloseM) break;
  }
  return found;
}

}  // namespace overfly::server
