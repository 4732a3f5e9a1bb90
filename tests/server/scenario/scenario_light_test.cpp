// The light of a scenario over a world.
#include "server/scenario/document/scenario_light.hpp"

#include <gtest/gtest.h>

#include <cstdio>

#include "server/scenario/document/scenario_file.hpp"

namespace overfly::server {
namespace {

/// Reda and Andreas, NREL/TP-560-34302, table A5.1, whose air is thinner: at sea level's pressure
/// the sun appears 0.004 deg higher.
TEST(ScenarioLight, ComesFromTheSunAtItsTimeOverTheWorldsOrigin) {
  const nlohmann::json document = {{"format_version", 1},
                                   {"world", {{"builtin", nlohmann::json::object()}}},
                                   {"flight", {{"course", nlohmann::json::object()}}},
                                   {"light", {{"time_utc", "2003-10-17T19:30:30Z"}}}};
  const auto scenario = resolve_scenario(document, {}, "/");
  ASSERT_TRUE(scenario.ok()) << scenario.error().message;
  const auto dress = world_dress(*scenario, geodetic_from_deg(39.742476, -105.1786, 1830.14));
  ASSERT_TRUE(dress.ok()) << dress.error().message;
  ASSERT_EQ(dress->size(), 1U);
  EXPECT_EQ(dress->front().first, "light");
  double azimuth_deg = 0.0;
  double elevation_deg = 0.0;
  ASSERT_EQ(std::sscanf(dress->front().second.c_str(),
                        "sun at azimuth %lf deg, elevation %lf deg",
                        &azimuth_deg,
                        &elevation_deg),
            2)
      << dress->front().second;
  EXPECT_NEAR(azimuth_deg, 194.340, 0.01);
  EXPECT_NEAR(elevation_deg, 39.89, 0.05);
}

}  // namespace
}  // namespace overfly::server
