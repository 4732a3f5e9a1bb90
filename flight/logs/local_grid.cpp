#include "flight/logs/local_grid.hpp"

#include <algorithm>
#include <cmath>

#include "core/motion/pose.hpp"

namespace overfly::flight::logs {
namespace {

constexpr double kArduPilotDegPerM = 1e-7 / 0.011131884502145034;
constexpr double kPx4RadiusM = 6371000.0;

double wrap_lon_deg(double lon_deg) {
  return lon_deg - 360.0 * std::floor((lon_deg + 180.0) / 360.0);
}

Eigen::Vector2d ardupilot_from_local(const LocalOrigin& origin, double north_m, double east_m) {
  const double lat_step_deg = north_m * kArduPilotDegPerM;
  const double shrink = std::max(0.01, std::cos(rad_from_deg(origin.lat_deg + lat_step_deg / 2.0)));
  return {origin.lat_deg + lat_step_deg, origin.lon_deg + east_m * kArduPilotDegPerM / shrink};
}

/// Inverse azimuthal equidistant projection (Snyder 1987, USGS Professional Paper 1395, eq. 20-14,
/// 20-15, 25-15).
Eigen::Vector2d px4_from_local(const LocalOrigin& origin, double north_m, double east_m) {
  const double distance_m = std::hypot(north_m, east_m);
  if (distance_m == 0.0) return {origin.lat_deg, origin.lon_deg};
  const double c = distance_m / kPx4RadiusM;
  const double lat_rad = rad_from_deg(origin.lat_deg);
  const double sin_lat = std::clamp(
      std::cos(c) * std::sin(lat_rad) + north_m * std::sin(c) * std::cos(lat_rad) / distance_m,
      -1.0,
      1.0);
  const double lon_step_rad = std::atan2(
      east_m * std::sin(c),
      distance_m * std::cos(lat_rad) * std::cos(c) - north_m * std::sin(lat_rad) * std::sin(c));
  return {deg_from_rad(std::asin(sin_lat)), origin.lon_deg + deg_from_rad(lon_step_rad)};
}

Eigen::Vector2d ardupilot_from_geodetic(const LocalOrigin& origin,
                                        double lat_step_deg,
                                        double lon_step_deg) {
  const double shrink = std::max(0.01, std::cos(rad_from_deg(origin.lat_deg + lat_step_deg / 2.0)));
  return Eigen::Vector2d(lat_step_deg, lon_step_deg * shrink) / kArduPilotDegPerM;
}

/// Azimuthal equidistant projection (Snyder 1987, eq. 5-3a, 22-4, 22-5, 25-2).
Eigen::Vector2d px4_from_geodetic(const LocalOrigin& origin,
                                  double lat_step_deg,
                                  double lon_step_deg) {
  const double lat_1_rad = rad_from_deg(origin.lat_deg);
  const double lat_rad = rad_from_deg(origin.lat_deg + lat_step_deg);
  const double step_rad = rad_from_deg(lon_step_deg);
  const double half_lat = std::sin(rad_from_deg(lat_step_deg) / 2.0);
  const double half_lon = std::sin(step_rad / 2.0);
  const double c =
      2.0 *
      std::asin(std::min(1.0,
                         std::sqrt(half_lat * half_lat +
                                   std::cos(lat_1_rad) * std::cos(lat_rad) * half_lon * half_lon)));
  const double k = c < 1e-12 ? 1.0 : c / std::sin(c);
  return kPx4RadiusM * k *
         Eigen::Vector2d(std::cos(lat_1_rad) * std::sin(lat_rad) -
                             std::sin(lat_1_rad) * std::cos(lat_rad) * std::cos(step_rad),
                         std::cos(lat_rad) * std::sin(step_rad));
}

}  // namespace

Eigen::Vector3d local_from_geodetic(const LocalOrigin& origin, const Eigen::Vector3d& geodetic) {
  const double lat_step_deg = geodetic.x() - origin.lat_deg;
  const double lon_step_deg = wrap_lon_deg(geodetic.y() - origin.lon_deg);
  const Eigen::Vector2d plane = origin.grid == LocalGrid::kArduPilot
                                    ? ardupilot_from_geodetic(origin, lat_step_deg, lon_step_deg)
                                    : px4_from_geodetic(origin, lat_step_deg, lon_step_deg);
  return {plane.x(), plane.y(), origin.alt_msl_m - geodetic.z()};
}

Eigen::Vector3d geodetic_from_local(const LocalOrigin& origin, const Eigen::Vector3d& ned_m) {
  const Eigen::Vector2d point = origin.grid == LocalGrid::kArduPilot
                                    ? ardupilot_from_local(origin, ned_m.x(), ned_m.y())
                                    : px4_from_local(origin, ned_m.x(), ned_m.y());
  return {point.x(), wrap_lon_deg(point.y()), origin.alt_msl_m - ned_m.z()};
}

LocalOrigin origin_of_local(LocalGrid grid,
                            const Eigen::Vector3d& geodetic,
                            const Eigen::Vector3d& ned_m) {
  LocalOrigin origin{geodetic.x(), geodetic.y(), geodetic.z() + ned_m.z(), grid};
  // Fixed-point iteration: the error shrinks by the ratio of the distance to the earth's radius.
  for (int i = 0; i < 6; ++i) {
    const Eigen::Vector3d reached = geodetic_from_local(origin, ned_m);
    origin.lat_deg += geodetic.x() - reached.x();
    origin.lon_deg += geodetic.y() - reached.y();
  }
  return origin;
}

}  // namespace overfly::flight::logs
