// Against published positions, moments and closed forms.
#include "core/earth/sun_position.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "core/motion/pose.hpp"

namespace overfly {
namespace {

std::int64_t utc_ns(int year, unsigned month, unsigned day, int hour, int minute, int second = 0) {
  using namespace std::chrono;
  const sys_days midnight = std::chrono::year{year} / month / day;
  const auto moment = midnight + hours{hour} + minutes{minute} + seconds{second};
  return duration_cast<nanoseconds>(moment.time_since_epoch()).count();
}

double azimuth_deg(const SunPosition& sun) { return deg_from_rad(sun.azimuth_rad); }
double elevation_deg(const SunPosition& sun) { return deg_from_rad(sun.elevation_rad); }

TEST(SunPosition, MatchesTheExampleOfTheSolarPositionAlgorithm) {
  // Reda and Andreas, NREL/TP-560-34302, table A5.1: 2003-10-17 12:30:30 at UTC - 7 h.
  const Geodetic golden = geodetic_from_deg(39.742476, -105.1786, 1830.14);
  const SunPosition sun = sun_position(
      utc_ns(2003, 10, 17, 19, 30, 30), golden, {.pressure_hpa = 820.0, .temperature_c = 11.0});
  EXPECT_NEAR(deg_from_rad(sun.apparent_elevation_rad), 90.0 - 50.11162, 0.01);
  EXPECT_NEAR(azimuth_deg(sun), 194.34024, 0.01);
}

TEST(SunPosition, MatchesTheExampleOfAstronomicalAlgorithms) {
  // Meeus 1998, example 25.a: 1992-10-13 at 0 h of dynamical time (59 s before universal time):
  // declination -7.78507 deg. At the pole that is the elevation, less a parallax of 8.7".
  const Geodetic pole = geodetic_from_deg(90.0, 0.0, 0.0);
  EXPECT_NEAR(elevation_deg(sun_position(utc_ns(1992, 10, 12, 23, 59, 1), pole)),
              -7.78507 - 8.7 / 3600.0,
              1e-4);
}

TEST(SunPosition, StandsOnTheEquatorAtTheEquinoxes) {
  // At the pole the elevation is the declination. Moments: the almanacs' for 2020, to the minute;
  // the declination moves by 0.0003 deg in one.
  const Geodetic pole = geodetic_from_deg(90.0, 0.0, 0.0);
  EXPECT_NEAR(elevation_deg(sun_position(utc_ns(2020, 3, 20, 3, 50), pole)), 0.0, 0.01);
  EXPECT_NEAR(elevation_deg(sun_position(utc_ns(2020, 9, 22, 13, 31), pole)), 0.0, 0.01);
}

TEST(SunPosition, ReachesTheObliquityAtTheSolstices) {
  constexpr double kObliquityDeg = 23.4366;  // of 2020
  const Geodetic north_pole = geodetic_from_deg(90.0, 0.0, 0.0);
  const Geodetic south_pole = geodetic_from_deg(-90.0, 0.0, 0.0);
  EXPECT_NEAR(
      elevation_deg(sun_position(utc_ns(2020, 6, 20, 21, 44), north_pole)), kObliquityDeg, 0.01);
  EXPECT_NEAR(
      elevation_deg(sun_position(utc_ns(2020, 12, 21, 10, 2), south_pole)), kObliquityDeg, 0.01);
}

TEST(SunPosition, CulminatesWhenTheEquationOfTimeSays) {
  // Extremes of the equation of time: +16 min 26 s early in November, -14 min 14 s in February.
  const Geodetic greenwich = geodetic_from_deg(51.4779, 0.0, 0.0);
  EXPECT_NEAR(azimuth_deg(sun_position(utc_ns(2020, 11, 3, 11, 43, 34), greenwich)), 180.0, 0.05);
  EXPECT_NEAR(azimuth_deg(sun_position(utc_ns(2020, 2, 11, 12, 14, 14), greenwich)), 180.0, 0.05);
}

TEST(SunPosition, StandsInTheNorthAtNoonSouthOfTheTropics) {
  // Melbourne on the June solstice: elevation at noon 90 - 37.81 - 23.44 deg.
  const Geodetic melbourne = geodetic_from_deg(-37.81, 144.96, 0.0);
  double highest = -90.0;
  double azimuth_at_highest = 0.0;
  for (int minute = 0; minute < 24 * 60; ++minute) {
    const SunPosition sun =
        sun_position(utc_ns(2020, 6, 20, 12, 0) + minute * 60'000'000'000LL, melbourne);
    if (elevation_deg(sun) <= highest) continue;
    highest = elevation_deg(sun);
    azimuth_at_highest = azimuth_deg(sun);
  }
  EXPECT_NEAR(highest, 90.0 - 37.81 - 23.4366, 0.01);
  EXPECT_NEAR(std::remainder(azimuth_at_highest, 360.0), 0.0, 0.3);
}

TEST(SunPosition, RisesInTheEastAndSetsInTheWestOnBothHemispheres) {
  for (const double lat_deg : {-35.0, 0.0, 48.0}) {
    for (const double lon_deg : {-120.0, 0.0, 151.0}) {
      const Geodetic place = geodetic_from_deg(lat_deg, lon_deg, 0.0);
      const std::int64_t noon_ns =
          utc_ns(2020, 3, 20, 12, 7) - static_cast<std::int64_t>(lon_deg / 15.0 * 3600e9);
      constexpr std::int64_t kThreeHoursNs = 3 * 3600 * 1'000'000'000LL;
      EXPECT_LT(std::sin(sun_position(noon_ns + kThreeHoursNs, place).azimuth_rad), -0.6);
      EXPECT_GT(std::sin(sun_position(noon_ns - kThreeHoursNs, place).azimuth_rad), 0.6);
      // At the equinox the sun climbs to 90 deg less the latitude everywhere.
      EXPECT_NEAR(elevation_deg(sun_position(noon_ns, place)), 90.0 - std::abs(lat_deg), 0.5);
    }
  }
}

TEST(SunPosition, IsLiftedByTheAirAtTheHorizon) {
  // Bennett's and Saemundsson's formulas both give about 29 minutes of arc at true elevation 0.
  const Geodetic equator = geodetic_from_deg(0.0, 0.0, 0.0);
  std::int64_t low = utc_ns(2020, 3, 20, 12, 0);
  std::int64_t high = utc_ns(2020, 3, 20, 20, 0);
  while (high - low > 1'000'000) {
    const std::int64_t middle = low + (high - low) / 2;
    (sun_position(middle, equator).elevation_rad > 0.0 ? low : high) = middle;
  }
  const SunPosition sunset = sun_position(low, equator);
  EXPECT_NEAR(60.0 * deg_from_rad(sunset.apparent_elevation_rad), 29.0, 1.0);
  EXPECT_NEAR(azimuth_deg(sunset), 270.0, 0.5);
}

}  // namespace
}  // namespace overfly
