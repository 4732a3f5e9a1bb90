// Positions that autopilots give in metres from an origin, as latitude and longitude.
#pragma once

#include <Eigen/Core>

namespace overfly::flight::logs {

/// How an autopilot turns latitude and longitude into metres. Neither uses WGS84's radii: at middle
/// latitudes their metres differ from true ones by up to 0.5 %, 16 m on a course of 3.3 km. The
/// autopilot's own formula must be inverted to get its latitude and longitude back.
enum class LocalGrid {
  /// 0.011131884502145034 m per 1e-7 deg in both directions; east times the cosine of the latitude
  /// half way between (ArduPilot's AP_Common/Location).
  kArduPilot,
  /// Azimuthal equidistant projection of a sphere of 6371000 m (PX4's MapProjection).
  kPx4,
};

/// Where local positions count from. The height is above mean sea level.
struct LocalOrigin {
  double lat_deg = 0.0;
  double lon_deg = 0.0;
  double alt_msl_m = 0.0;
  LocalGrid grid = LocalGrid::kArduPilot;
  friend bool operator==(const LocalOrigin&, const LocalOrigin&) = default;
};

/// Latitude, longitude [deg] and height above mean sea level [m] of a local position.
[[nodiscard]] Eigen::Vector3d geodetic_from_local(const LocalOrigin& origin,
                                                  const Eigen::Vector3d& ned_m);

/// The inverse: north, east, down [m] from the origin to a point (latitude, longitude [deg], height
/// above mean sea level [m]).
[[nodiscard]] Eigen::Vector3d local_from_geodetic(const LocalOrigin& origin,
                                                  const Eigen::Vector3d& geodetic);

/// The origin from which `ned_m` leads to the point (latitude, longitude [deg], height [m]).
[[nodiscard]] LocalOrigin origin_of_local(LocalGrid grid,
                                          const Eigen::Vector3d& geodetic,
                                          const Eigen::Vector3d& ned_m);

}  // namespace overfly::flight::logs
