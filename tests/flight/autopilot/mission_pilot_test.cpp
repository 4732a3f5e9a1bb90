// Which item a pilot flies, from where and how fast.
#include "flight/autopilot/mission_pilot.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/flight/autopilot/flights.hpp"

namespace overfly::autopilot {
namespace {

using testing::item_of;
using testing::waypoint;

FlightState flying_at(double east_m, double north_m, double yaw_rad = 0.0) {
  FlightState state;
  state.position_world_m = {east_m, north_m, 300.0};
  state.attitude.yaw_rad = yaw_rad;
  state.airspeed_m_s = 20.0;
  state.v_world_m_s = {20.0 * std::sin(yaw_rad), 20.0 * std::cos(yaw_rad), 0.0};
  state.gravity_m_s2 = dynamics::kStandardGravityMS2;
  return state;
}

MissionPilot pilot_of(std::vector<MissionItem> items, const Parameters& parameters = {}) {
  return {parameters,
          {.home_world_m = Eigen::Vector3d::Zero(), .items = std::move(items)},
          [](const Eigen::Vector2d&) { return 0.0; }};
}

TEST(MissionPilot, StartsAnItemWhereTheAircraftIs) {
  MissionPilot pilot = pilot_of({waypoint(0, 500, 300), waypoint(0, 1000, 300)});
  // Beyond it, seen from the item before.
  pilot.start(flying_at(0, 1500), 1);
  (void)pilot.update(flying_at(0, 1500), 0.01);
  EXPECT_EQ(pilot.item(), 1U);
  (void)pilot.update(flying_at(0, 1000, kPi), 0.01);
  EXPECT_EQ(pilot.item(), 2U);
}

TEST(MissionPilot, HoldsTheSpeedThatTheMissionSetLast) {
  MissionItem faster = item_of(MissionCommand::kSetSpeed);
  faster.airspeed_m_s = 15.0;
  Parameters parameters;
  for (const bool set : {true, false}) {
    MissionPilot pilot = pilot_of({set ? faster : waypoint(0, 0, 300), waypoint(0, 500, 300)});
    pilot.start(flying_at(0, 0), 1);
    const auto airspeed = [&] { return pilot.update(flying_at(0, 0), 0.01).energy.airspeed_m_s; };
    EXPECT_EQ(airspeed(), set ? 15.0 : parameters.airspeed_cruise);
    Parameters others;
    others.airspeed_cruise = 14.0;
    pilot.set_parameters(others);
    EXPECT_EQ(airspeed(), set ? 15.0 : 14.0);
  }
}

TEST(MissionPilot, GoesOnWithItsTurnsWhenParametersChange) {
  MissionItem circle = item_of(MissionCommand::kLoiter, waypoint(0, 0, 300));
  circle.radius_m = 100.0;
  circle.turns = 1.0;
  MissionPilot pilot = pilot_of({circle, item_of(MissionCommand::kReturn)});
  const auto fly_to = [&](double from_rad, double to_rad) {
    for (double bearing = from_rad; bearing < to_rad; bearing += 0.05) {
      const FlightState at = flying_at(
          100.0 * std::sin(bearing), 100.0 * std::cos(bearing), wrap_pi(bearing + 0.5 * kPi));
      (void)pilot.update(at, 0.25);
    }
  };
  pilot.start(flying_at(0, 100, 0.5 * kPi));
  fly_to(0.0, 4.0);
  pilot.set_parameters({.rll2srv_rmax = 60.0});
  fly_to(4.0, 6.0);
  EXPECT_EQ(pilot.item(), 0U);
  fly_to(6.0, 6.6);
  ASSERT_EQ(pilot.phase(), FlightPhase::kReturn);
  pilot.set_parameters({.rtl_altitude = 170.0});
  EXPECT_EQ(pilot.update(flying_at(0, 100), 0.01).energy.up_m, 170.0);
}

TEST(MissionPilot, CountsNoTurnsOnTheWayToAnotherCircle) {
  MissionItem circle = item_of(MissionCommand::kLoiter, waypoint(0, 0, 300));
  circle.radius_m = 0.0;  // that of the parameters
  circle.turns = 1.0;
  MissionPilot pilot = pilot_of({circle, item_of(MissionCommand::kReturn)});
  pilot.set_parameters({.wp_loiter_rad = 100.0});
  const auto fly_around = [&](double turns) {
    for (double bearing = 0.0; bearing < turns * 2.0 * kPi; bearing += 0.05) {
      const FlightState at = flying_at(
          100.0 * std::sin(bearing), 100.0 * std::cos(bearing), wrap_pi(bearing + 0.5 * kPi));
      (void)pilot.update(at, 0.25);
    }
  };
  pilot.start(flying_at(0, 100, 0.5 * kPi));
  fly_around(0.5);
  pilot.set_parameters({.wp_loiter_rad = 500.0});
  fly_around(2.0);
  EXPECT_EQ(pilot.item(), 0U) << "400 m inside of the circle";
}

}  // namespace
}  // namespace overfly::autopilot
