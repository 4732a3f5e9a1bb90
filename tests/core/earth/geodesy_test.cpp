#include "core/earth/geodesy.hpp"

#include <gtest/gtest.h>

#include <GeographicLib/LocalCartesian.hpp>
#include <cmath>
#include <random>

#include "core/motion/pose.hpp"
#include "tests/support/support.hpp"

namespace overfly {
namespace {

using overfly::testing::larger_error;

// The closed form of EPSG guidance note 7-2, section 4.1.1, with WGS84's constants: independent of
// the library that the code calls.
Eigen::Vector3d ecef_by_closed_form(const Geodetic& point) {
  constexpr double kSemiMajor_m = 6378137.0;
  constexpr double kFlattening = 1.0 / 298.257223563;
  constexpr double kEccentricity2 = kFlattening * (2.0 - kFlattening);
  const double sin_lat = std::sin(point.lat_rad);
  const double cos_lat = std::cos(point.lat_rad);
  const double prime_vertical_m =
      kSemiMajor_m / std::sqrt(1.0 - kEccentricity2 * sin_lat * sin_lat);
  const double radius_m = prime_vertical_m + point.alt_ellipsoid_m;
  return {radius_m * cos_lat * std::cos(point.lon_rad),
          radius_m * cos_lat * std::sin(point.lon_rad),
          (prime_vertical_m * (1.0 - kEccentricity2) + point.alt_ellipsoid_m) * sin_lat};
}

class RandomPoints {
 public:
  Geodetic next() {
    return geodetic_from_deg(lat_deg_(engine_), lon_deg_(engine_), alt_m_(engine_));
  }

 private:
  std::mt19937_64 engine_{7};
  std::uniform_real_distribution<double> lat_deg_{-90.0, 90.0};
  std::uniform_real_distribution<double> lon_deg_{-180.0, 180.0};
  std::uniform_real_distribution<double> alt_m_{-500.0, 20000.0};
};

constexpr int kPoints = 100000;
constexpr double kTolerance_m = 1e-3;

TEST(Geodesy, EcefMatchesTheClosedFormAtRandomPoints) {
  RandomPoints points;
  double worst_m = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const Geodetic point = points.next();
    worst_m =
        larger_error(worst_m, (ecef_from_geodetic(point) - ecef_by_closed_form(point)).norm());
  }
  EXPECT_LT(worst_m, kTolerance_m);
}

TEST(Geodesy, GeodeticFromEcefInvertsTheClosedFormAtRandomPoints) {
  RandomPoints points;
  double worst_m = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const Eigen::Vector3d p_ecef = ecef_by_closed_form(points.next());
    const Eigen::Vector3d again = ecef_by_closed_form(geodetic_from_ecef(p_ecef));
    worst_m = larger_error(worst_m, (again - p_ecef).norm());
  }
  EXPECT_LT(worst_m, kTolerance_m);
}

TEST(LocalFrame, MatchesGeographicLibsLocalCartesianAtRandomPoints) {
  const Geodetic origin = geodetic_from_deg(39.35, -86.03, 180.0);
  const LocalFrame frame(origin);
  const GeographicLib::LocalCartesian reference(39.35, -86.03, 180.0);
  RandomPoints points;
  double worst_m = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const Geodetic point = points.next();
    Eigen::Vector3d expected;
    reference.Forward(deg_from_rad(point.lat_rad),
                      deg_from_rad(point.lon_rad),
                      point.alt_ellipsoid_m,
                      expected.x(),
                      expected.y(),
                      expected.z());
    worst_m = larger_error(worst_m, (frame.world_from_geodetic(point) - expected).norm());
  }
  EXPECT_LT(worst_m, kTolerance_m);
}

TEST(LocalFrame, RoundTripsWorldPoints) {
  const LocalFrame frame(geodetic_from_deg(-33.9, 151.2, 20.0));
  for (const Eigen::Vector3d& p_world : {Eigen::Vector3d(0, 0, 0),
                                         Eigen::Vector3d(5000, -7000, 300),
                                         Eigen::Vector3d(-50000, 50000, 1000)}) {
    const Eigen::Vector3d again = frame.world_from_geodetic(frame.geodetic_from_world(p_world));
    EXPECT_LT((again - p_world).norm(), 1e-6);
  }
}

TEST(LocalFrame, EarthCurvesAwayFromTheTangentPlane) {
  const LocalFrame frame(geodetic_from_deg(0.0, 0.0, 0.0));
  // Along the equator the section is a circle of the semi-major axis: drop = a (1 - cos phi).
  const double angle_rad = 10000.0 / 6378137.0;
  const Eigen::Vector3d p_world = frame.world_from_geodetic({0.0, angle_rad, 0.0});
  EXPECT_NEAR(p_world.z(), -6378137.0 * (1.0 - std::cos(angle_rad)), 1e-6);
  EXPECT_NEAR(p_world.z(), -7.84, 0.01);
}

TEST(LocalFrame, LocalUpLeansOutwardsAwayFromTheOrigin) {
  const LocalFrame frame(geodetic_from_deg(0.0, 0.0, 0.0));
  const double angle_rad = 0.01;
  const Eigen::Vector3d up_world =
      frame.R_world_enu_at({0.0, angle_rad, 0.0}) * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(up_world.x(), std::sin(angle_rad), 1e-12);
  EXPECT_NEAR(up_world.z(), std::cos(angle_rad), 1e-12);
}

}  // namespace
}  // namespace overfly
