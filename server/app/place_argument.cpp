#include "server/app/place_argument.hpp"

#include <cmath>
#include <cstdio>

namespace overfly::app {

Result<Geodetic> place_from(const std::string& option, const std::string& text) {
  double lat_deg = 0.0;
  double lon_deg = 0.0;
  double alt_m = 0.0;
  int used = 0;
  const bool three =
      std::sscanf(text.c_str(), "%lf,%lf,%lf%n", &lat_deg, &lon_deg, &alt_m, &used) == 3 &&
      static_cast<std::size_t>(used) == text.size();
  if (!three || !(std::abs(lat_deg) <= 89.0) || !(std::abs(lon_deg) <= 180.0) ||
      !(alt_m >= -500.0 && alt_m <= 9000.0)) {
    return Error{ErrorCode::kInvalidArgument,
                 option + " " + text +
                     ": must be LAT,LON,HEIGHT with degrees in [-89, 89] and [-180, 180] and a "
                     "height in [-500, 9000] m"};
  }
  return geodetic_from_deg(lat_deg, lon_deg, alt_m);
}

}  // namespace overfly::app
