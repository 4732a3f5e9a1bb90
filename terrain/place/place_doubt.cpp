#include "terrain/place/place_doubt.hpp"

#include <algorithm>
#include <cstdio>

#include "terrain/place/crs_transform.hpp"
#include "terrain/place/full_turn.hpp"

namespace overfly::terrain {

std::optional<std::string> place_doubt(const Georeference& place,
                                       int width_px,
                                       int height_px,
                                       const std::string& file) {
  double west = 0.0;
  double south = 0.0;
  double east = 0.0;
  double north = 0.0;
  const char* area = nullptr;
  if (!place.crs.GetAreaOfUse(&west, &south, &east, &north, &area) || west < -180.0) {
    return std::nullopt;
  }
  if (west > east) east += 360.0;  // across the antimeridian
  const auto transform = CrsTransform::create(place.crs, wgs84_crs(), file);
  if (!transform) return std::nullopt;
  Eigen::Matrix2Xd middle(2, 1);
  place.transform.crs_from_pixel(0.5 * width_px, 0.5 * height_px, middle(0, 0), middle(1, 0));
  if (!(*transform)->apply(middle)) return std::nullopt;  // laying out the world reports it
  const double lon = unwrapped(middle(0, 0), 0.5 * (west + east), 360.0);
  const double lat = middle(1, 0);
  const double outside = std::max({west - lon, lon - east, south - lat, lat - north, 0.0});
  constexpr double kFarDeg = 3.0;
  if (outside < kFarDeg) return std::nullopt;
  char text[400];
  std::snprintf(text,
                sizeof(text),
                ": its centre lies at %.4f deg N, %.4f deg E, %.0f deg outside the area of its "
                "coordinate reference system (%.0f to %.0f deg N, %.0f to %.0f deg E); are its "
                "coordinates in the right unit and zone?",
                lat,
                middle(0, 0),
                outside,
                south,
                north,
                west,
                east > 180.0 ? east - 360.0 : east);
  return file + text;
}

}  // namespace overfly::terrain
