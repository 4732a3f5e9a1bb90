// The loops that hold angles: rate limits, turns, trims.
#include "flight/autopilot/attitude_control.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>
#include <vector>

#include "flight/autopilot/energy_control.hpp"
#include "flight/dynamics/trim.hpp"
#include "tests/flight/autopilot/flights.hpp"

namespace overfly::autopilot {
namespace {

/// An aircraft that holds height and airspeed while a test demands its bank.
class BankFlight {
 public:
  BankFlight(const std::string& name, double rate_max_deg_s) : setup_(testing::setup_of(name)) {
    setup_.parameters.rll2srv_rmax = rate_max_deg_s;
    const dynamics::Trim level =
        dynamics::trim(setup_.airframe,
                       setup_.environment,
                       {.airspeed_m_s = setup_.parameters.airspeed_cruise, .up_m = 300.0})
            .value();
    aircraft_ =
        dynamics::Aircraft::create({.airframe = setup_.airframe, .environment = setup_.environment},
                                   level.state({0.0, 0.0, 300.0}, 0.0),
                                   level.controls)
            .value();
    attitude_.emplace(setup_.parameters, setup_.airframe);
    energy_.emplace(setup_.parameters, setup_.airframe);
    attitude_->start_from(level.controls);
    energy_->start_from(level.controls.throttle, level.pitch_rad);
  }

  FlightState step(double roll_rad) {
    const FlightState state = flight_state(*aircraft_);
    const auto energy = energy_->update(
        {300.0, 0.0, setup_.parameters.airspeed_cruise}, state, 1.0 / kControlRateHz);
    dynamics::Controls commands =
        attitude_->update({roll_rad, energy.pitch_rad}, state, 1.0 / kControlRateHz);
    commands.throttle = energy.throttle;
    for (int i = 0; i < 4; ++i) EXPECT_TRUE(aircraft_->step(commands, 1.0 / kMotionRateHz).ok());
    return flight_state(*aircraft_);
  }

 private:
  MissionSetup setup_;
  std::optional<dynamics::Aircraft> aircraft_;
  std::optional<AttitudeControl> attitude_;
  std::optional<EnergyControl> energy_;
};

using RollCase = std::tuple<const char*, double>;
class RollRate : public ::testing::TestWithParam<RollCase> {};

TEST_P(RollRate, ReachesItsLimitInAReversalAndNeverPassesItByFivePercent) {
  const auto& [name, limit_deg_s] = GetParam();
  BankFlight flight(name, limit_deg_s);
  double fastest = 0.0;
  double steepest = 0.0;
  const double bank_deg = 35.0;
  for (int i = 0; i < 3000; ++i) {
    const double side = (i / 600) % 2 == 0 ? 1.0 : -1.0;
    const FlightState state = flight.step(side * rad_from_deg(bank_deg));
    fastest = std::max(fastest, std::abs(deg_from_rad(state.omega_body_rad_s.x())));
    steepest = std::max(steepest, std::abs(deg_from_rad(state.attitude.roll_rad)));
  }
  testing::print_figure(std::string(name) + ", limit " + std::to_string(int(limit_deg_s)) +
                            " deg/s: fastest roll over limit",
                        fastest / limit_deg_s);
  EXPECT_LE(fastest, 1.05 * limit_deg_s);
  EXPECT_GE(fastest, 0.95 * limit_deg_s);
  EXPECT_LE(steepest, bank_deg + 1.5);
}

INSTANTIATE_TEST_SUITE_P(Airframes,
                         RollRate,
                         ::testing::Combine(::testing::Values("foam_trainer", "piper_cub_third"),
                                            ::testing::Values(25.0, 45.0, 65.0)));

TEST(AttitudeControl, FliesTurnsOfTheCoordinatedRadius) {
  for (const char* name : {"foam_trainer", "piper_cub_third"}) {
    for (const double bank_deg : {15.0, -30.0, 35.0}) {
      BankFlight flight(name, 45.0);
      FlightState state;
      for (int i = 0; i < 2000; ++i) state = flight.step(rad_from_deg(bank_deg));
      // A circle from the heading's change over two seconds, against V^2 / (g tan(bank)).
      double travelled_m = 0.0;
      const double before = state.attitude.yaw_rad;
      for (int i = 0; i < 200; ++i) {
        state = flight.step(rad_from_deg(bank_deg));
        travelled_m += state.v_world_m_s.head<2>().norm() / kControlRateHz;
      }
      const double radius_m = travelled_m / wrap_pi(state.attitude.yaw_rad - before);
      const double expected_m = state.airspeed_m_s * state.airspeed_m_s /
                                (state.gravity_m_s2 * std::tan(rad_from_deg(bank_deg)));
      testing::print_figure(std::string(name) + ", bank " + std::to_string(int(bank_deg)) +
                                " deg: radius over the coordinated one",
                            radius_m / expected_m);
      EXPECT_NEAR(radius_m / expected_m, 1.0, 0.03) << name << " " << bank_deg;
      EXPECT_NEAR(deg_from_rad(state.attitude.roll_rad), bank_deg, 0.2) << name;
      // Coordinated: no side force.
      EXPECT_LT(std::abs(state.specific_force_body_m_s2.y()), 0.05) << name << " " << bank_deg;
      EXPECT_NEAR(state.position_world_m.z(), 300.0, 0.5) << name;
    }
  }
}

TEST(AttitudeControl, StartsFromTheTrimWithoutATransient) {
  BankFlight flight("piper_cub_third", 45.0);
  for (int i = 0; i < 500; ++i) {
    const FlightState state = flight.step(0.0);
    ASSERT_NEAR(state.position_world_m.z(), 300.0, 1e-3);
    ASSERT_LT(state.omega_body_rad_s.norm(), 1e-3);
  }
}

TEST(AttitudeControl, UsesASurfaceToBothOfItsEnds) {
  MissionSetup setup = testing::setup_of("piper_cub_third");
  setup.airframe.elevator.min_rad = rad_from_deg(-10.0);
  setup.airframe.elevator.max_rad = rad_from_deg(25.0);
  FlightState state;
  state.airspeed_m_s = setup.parameters.airspeed_cruise;
  state.gravity_m_s2 = 9.81;
  AttitudeControl held(setup.parameters, setup.airframe);
  held.start_from({.elevator_rad = rad_from_deg(15.0)});
  EXPECT_NEAR(deg_from_rad(held.update({}, state, 0.01).elevator_rad), 15.0, 1e-9);
  AttitudeControl up(setup.parameters, setup.airframe);
  AttitudeControl down(setup.parameters, setup.airframe);
  dynamics::Controls highest;
  dynamics::Controls lowest;
  for (int i = 0; i < 2000; ++i) {
    highest = up.update({0.0, 1.0}, state, 0.01);
    lowest = down.update({0.0, -1.0}, state, 0.01);
  }
  EXPECT_NEAR(deg_from_rad(highest.elevator_rad), -10.0, 1e-9);
  EXPECT_NEAR(deg_from_rad(lowest.elevator_rad), 25.0, 1e-9);
}

}  // namespace
}  // namespace overfly::autopilot
