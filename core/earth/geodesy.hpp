// WGS84: geodetic, earth-centred and local tangent coordinates.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace overfly {

/// A point on WGS84 (EPSG:4979). The height is above the ellipsoid, never above sea level.
struct Geodetic {
  double lat_rad = 0.0;
  double lon_rad = 0.0;
  double alt_ellipsoid_m = 0.0;
};

[[nodiscard]] Geodetic geodetic_from_deg(double lat_deg, double lon_deg, double alt_ellipsoid_m);

/// Earth-centred earth-fixed coordinates (EPSG:4978) [m].
[[nodiscard]] Eigen::Vector3d ecef_from_geodetic(const Geodetic& point);
[[nodiscard]] Geodetic geodetic_from_ecef(const Eigen::Vector3d& p_ecef);

/// The `world` frame of a scenario: east-north-up, tangent to WGS84 at an origin [m].
/// The frame is flat, the earth is not: a point 10 km away at the origin's height has up = -7.8 m.
class LocalFrame {
 public:
  explicit LocalFrame(const Geodetic& origin);

  [[nodiscard]] const Geodetic& origin() const { return origin_; }
  [[nodiscard]] Eigen::Vector3d world_from_ecef(const Eigen::Vector3d& p_ecef) const;
  [[nodiscard]] Eigen::Vector3d ecef_from_world(const Eigen::Vector3d& p_world) const;
  [[nodiscard]] Eigen::Vector3d world_from_geodetic(const Geodetic& point) const;
  [[nodiscard]] Geodetic geodetic_from_world(const Eigen::Vector3d& p_world) const;

  /// R_world_enu of the local east-north-up axes at a point. Converts an attitude relative to the
  /// local horizon into one relative to the world frame.
  [[nodiscard]] Eigen::Quaterniond R_world_enu_at(const Geodetic& point) const;

 private:
  Geodetic origin_;
  Eigen::Vector3d origin_ecef_;
  Eigen::Matrix3d R_world_ecef_;
};

}  // namespace overfly
