// The standard atmosphere against the published tables, and the gravity of a place.
#include "flight/dynamics/environment.hpp"

#include <gtest/gtest.h>

#include <GeographicLib/NormalGravity.hpp>
#include <cmath>
#include <utility>

namespace overfly::dynamics {
namespace {

TEST(StandardAtmosphere, HasTheDensityOfTheTables) {
  // U.S. Standard Atmosphere 1976, table 1, geometric height: five digits.
  for (const auto& [alt_m, density] : {std::pair{0.0, 1.2250},
                                       {500.0, 1.1673},
                                       {1000.0, 1.1117},
                                       {2000.0, 1.0066},
                                       {5000.0, 0.73643},
                                       {10000.0, 0.41351},
                                       {15000.0, 0.19476},
                                       {20000.0, 0.088910}}) {
    EXPECT_NEAR(standard_density_kg_m3(alt_m) / density, 1.0, 1e-4) << alt_m;
  }
}

TEST(StandardAtmosphere, IsContinuousAndEndsAtItsLimits) {
  // Geopotential 11 km is 11019.07 m.
  EXPECT_NEAR(standard_density_kg_m3(11019.0) / standard_density_kg_m3(11019.2), 1.0, 1e-4);
  EXPECT_EQ(standard_density_kg_m3(1e9), standard_density_kg_m3(20000.0));
  EXPECT_EQ(standard_density_kg_m3(-1e9), standard_density_kg_m3(-5000.0));
}

TEST(Environment, HasTheGravityOfThePlace) {
  const Environment place = Environment::at(geodetic_from_deg(47.5, 8.5, 480.0), 432.0);
  double gamma_y = 0.0, gamma_z = 0.0;
  GeographicLib::NormalGravity::WGS84().Gravity(47.5, 480.0, gamma_y, gamma_z);
  EXPECT_NEAR(place.gravity_m_s2, std::hypot(gamma_y, gamma_z), 1e-6);
  EXPECT_EQ(place.density_kg_m3(68.0), standard_density_kg_m3(500.0));
}

}  // namespace
}  // namespace overfly::dynamics
