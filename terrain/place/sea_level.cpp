#include "terrain/sea_level.hpp"

#include <string>
#include <vector>

#include "terrain/place/geoid.hpp"

namespace overfly::terrain {

double sea_level_m(const Geodetic& place) {
  std::vector<std::string> warnings;  // of the model's choice, known to the caller
  const auto model = choose_geoid(
      VerticalDatum::kEgm96, std::nullopt, place.lat_rad, place.lon_rad, "sea level", warnings);
  if (!model) return 0.0;
  Eigen::Matrix2Xd at(2, 1);
  at << place.lon_rad, place.lat_rad;
  return geoid_separation_m(*model, at)(0);
}

}  // namespace overfly::terrain
