// Height and airspeed in flight: steps, climbs, turns and their limits.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/flight/autopilot/flights.hpp"
#include "tests/support/support.hpp"

namespace overfly::autopilot {
namespace {

using overfly::testing::larger_error;
using testing::fly;
using testing::item_of;
using testing::setup_of;
using testing::t_s;
using testing::waypoint;

TEST(EnergyControl, ClimbsToANewHeightAtConstantAirspeed) {
  for (const char* name : {"foam_trainer", "piper_cub_third"}) {
    MissionSetup setup = setup_of(name);
    setup.duration_max_s = 120.0;
    MissionItem circle = item_of(MissionCommand::kLoiter, waypoint(0.0, 0.0, 340.0));
    setup.mission.items = {circle};
    double slowest = 100.0;
    double fastest = 0.0;
    double highest = 0.0;
    const MissionFlight flight = fly(setup, [&](const MissionFlight& at) {
      const FlightState state = flight_state(at.aircraft());
      slowest = std::min(slowest, state.airspeed_m_s);
      fastest = std::max(fastest, state.airspeed_m_s);
      highest = std::max(highest, state.position_world_m.z());
      return true;
    });
    const double cruise = setup.parameters.airspeed_cruise;
    EXPECT_GT(slowest, 0.9 * cruise) << name;
    EXPECT_LT(fastest, 1.2 * cruise) << name;
    EXPECT_LT(highest, 342.0) << name;
    EXPECT_NEAR(flight.aircraft().state().position_world_m.z(), 340.0, 0.5) << name;
  }
}

TEST(EnergyControl, ChangesTheAirspeedAtConstantHeight) {
  MissionSetup setup = setup_of("piper_cub_third");
  MissionItem speed;
  speed.command = MissionCommand::kSetSpeed;
  speed.airspeed_m_s = 29.0;
  setup.mission.items = {waypoint(0, 500, 300), speed, waypoint(0, 3000, 300)};
  double off = 0.0;
  const MissionFlight flight = fly(setup, [&](const MissionFlight& at) {
    off = larger_error(off, std::abs(at.aircraft().state().position_world_m.z() - 300.0));
    return true;
  });
  EXPECT_LT(off, 4.0);
  EXPECT_NEAR(flight.aircraft().air_data().airspeed_m_s, 29.0, 0.2);
}

TEST(EnergyControl, NeverStallsWhenMoreClimbIsAskedThanTheThrustAllows) {
  MissionSetup setup = setup_of("foam_trainer");
  setup.parameters.tecs_clmb_max = 12.0;  // the airframe climbs 4.2 m/s
  setup.duration_max_s = 60.0;
  setup.mission.items = {item_of(MissionCommand::kLoiter, waypoint(0.0, 0.0, 1500.0))};
  const MissionFlight flight = fly(setup, [&](const MissionFlight& at) {
    const FlightState state = flight_state(at.aircraft());
    EXPECT_GT(state.airspeed_m_s, 0.9 * setup.parameters.airspeed_min) << t_s(at);
    return state.airspeed_m_s > 5.0;
  });
  EXPECT_GT(flight.aircraft().state().position_world_m.z(), 400.0);
}

TEST(EnergyControl, DescendsWithoutOverspeed) {
  MissionSetup setup = setup_of("piper_cub_third");
  setup.duration_max_s = 90.0;
  setup.mission.items = {item_of(MissionCommand::kLoiter, waypoint(0.0, 0.0, 100.0))};
  const MissionFlight flight = fly(setup, [&](const MissionFlight& at) {
    EXPECT_LT(at.aircraft().air_data().airspeed_m_s, setup.parameters.airspeed_max) << t_s(at);
    return true;
  });
  EXPECT_NEAR(flight.aircraft().state().position_world_m.z(), 100.0, 1.0);
}

}  // namespace
}  // namespace overfly::autopilot
