#include "server/maps/mercator.hpp"

#include <cmath>

#include "core/motion/pose.hpp"

namespace overfly::server {
namespace {

constexpr double kEquatorM = 2.0 * kPi * 6378137.0;

}  // namespace

Eigen::Vector2d mercator_from_geodetic(double lat_rad, double lon_rad) {
  return {0.5 + lon_rad / (2.0 * kPi), 0.5 - std::asinh(std::tan(lat_rad)) / (2.0 * kPi)};
}

Geodetic geodetic_from_mercator(const Eigen::Vector2d& place) {
  return {std::atan(std::sinh((0.5 - place.y()) * 2.0 * kPi)), (place.x() - 0.5) * 2.0 * kPi, 0.0};
}

double map_pixel_m(double lat_rad, int zoom) {
  return kEquatorM * std::cos(lat_rad) / (static_cast<double>(kMapTilePx) * std::ldexp(1.0, zoom));
}

}  // namespace overfly::server
