// Trimmed flights: they hold, they are what was asked, and impossible ones are explained.
#include "flight/dynamics/trim.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "core/motion/pose.hpp"
#include "flight/dynamics/aerodynamics.hpp"
#include "flight/dynamics/aircraft.hpp"
#include "tests/flight/dynamics/airframes.hpp"

namespace overfly::dynamics {
namespace {

using ::testing::HasSubstr;

TrimRequest level(double airspeed_m_s) {
  TrimRequest request;
  request.airspeed_m_s = airspeed_m_s;
  return request;
}

TEST(Trim, HoldsEveryFlightOfAGrid) {
  const Environment place;
  for (const char* name : testing::kAirframes) {
    const Airframe airframe = testing::airframe(name);
    const double slowest = stall_speed_m_s(airframe, place, 0.0);
    int flown = 0;
    for (const double factor : {1.25, 1.5, 2.0}) {
      for (const double climb_deg : {-4.0, 0.0, 4.0}) {
        for (const double bank_deg : {-40.0, 0.0, 20.0, 45.0}) {
          TrimRequest request =
              level(factor * slowest / std::sqrt(std::cos(rad_from_deg(bank_deg))));
          request.climb_rad = rad_from_deg(climb_deg);
          request.bank_rad = rad_from_deg(bank_deg);
          request.up_m = 200.0;
          const auto found = trim(airframe, place, request);
          if (!found.ok()) continue;  // idle or thrust limit; counted below
          ++flown;
          EXPECT_LE(found->residual, 1e-9);
          // The state itself, by the equations of motion of the aircraft.
          AircraftSetup setup;
          setup.airframe = airframe;
          const BodyState state = found->state({0.0, 0.0, 200.0}, 0.7);
          const auto aircraft = Aircraft::create(setup, state, found->controls);
          ASSERT_TRUE(aircraft.ok());
          EXPECT_NEAR(aircraft->air_data().airspeed_m_s, request.airspeed_m_s, 1e-9);
          EXPECT_NEAR(aircraft->specific_force_body_m_s2().y(), 0.0, 1e-8);
          const Eigen::Vector3d v = state.R_world_body * state.v_body_m_s;
          EXPECT_NEAR(std::asin(v.z() / v.norm()), request.climb_rad, 1e-9);
          EXPECT_NEAR(attitude_from(state.R_world_body).roll_rad, request.bank_rad, 1e-9);
          // Force over mass: gravity and the centripetal acceleration of the turn.
          const Eigen::Vector3d force = state.R_world_body * aircraft->specific_force_body_m_s2();
          const Eigen::Vector3d expected = Eigen::Vector3d(0, 0, place.gravity_m_s2) +
                                           Eigen::Vector3d(0, 0, -found->turn_rate_rad_s).cross(v);
          EXPECT_LT((force - expected).norm(), 1e-8);
          // The textbook's turn, up to the angle of attack: the thrust is inclined by it.
          EXPECT_NEAR(found->turn_rate_rad_s * request.airspeed_m_s,
                      place.gravity_m_s2 * std::tan(request.bank_rad),
                      0.08 * place.gravity_m_s2 * std::abs(std::tan(request.bank_rad)) + 1e-12);
        }
      }
    }
    EXPECT_GE(flown, 24) << name;
  }
}

TEST(Trim, FliesTheCircleThatWasAsked) {
  for (const char* name : testing::kAirframes) {
    AircraftSetup setup;
    setup.airframe = testing::airframe(name);
    TrimRequest request = level(testing::cruise_m_s(name));
    request.radius_m = -4.0 * request.airspeed_m_s;
    const auto turn = trim(setup.airframe, setup.environment, request);
    ASSERT_TRUE(turn.ok()) << turn.error().message;
    EXPECT_LT(turn->roll_rad, 0.0);
    auto aircraft = Aircraft::create(setup, turn->state({0, 0, 0}, 0.0), turn->controls).value();
    // Half a circle to the left: the opposite point lies 2 r to the left of the track, which
    // differs from the nose by the sideslip.
    const Eigen::Vector3d track = aircraft.state().R_world_body * aircraft.state().v_body_m_s;
    const Eigen::Vector3d right(track.y(), -track.x(), 0.0);
    const double half_s = kPi * 4.0;
    const int steps = static_cast<int>(std::ceil(half_s / 0.0025));
    for (int i = 0; i < steps; ++i) EXPECT_TRUE(aircraft.step(turn->controls, half_s / steps).ok());
    const Eigen::Vector3d opposite = 2.0 * *request.radius_m * right.normalized();
    EXPECT_LT((aircraft.state().position_world_m - opposite).norm(), 1e-4) << name;
  }
}

TEST(Trim, FollowsFromAThrottle) {
  const Airframe airframe = testing::airframe("piper_cub_third");
  const Environment place;
  TrimRequest request = level(20.0);
  request.throttle = 1.0;
  const auto climb = trim(airframe, place, request);
  ASSERT_TRUE(climb.ok()) << climb.error().message;
  EXPECT_GT(climb->climb_rad, 0.1);
  request.throttle = 0.0;
  const auto glide = trim(airframe, place, request);
  ASSERT_TRUE(glide.ok()) << glide.error().message;
  EXPECT_LT(glide->climb_rad, -0.05);
  // The same flight, asked by its climb.
  TrimRequest by_climb = level(20.0);
  by_climb.climb_rad = climb->climb_rad;
  EXPECT_NEAR(trim(airframe, place, by_climb)->controls.throttle, 1.0, 1e-9);
}

TEST(Trim, GivesTheLimitsOfEachAirframe) {
  const Environment place;
  for (const char* name : testing::kAirframes) {
    const Airframe airframe = testing::airframe(name);
    const double stall = stall_speed_m_s(airframe, place, 0.0);
    const auto at_power = [&](double v, double throttle) {
      TrimRequest request = level(v);
      request.throttle = throttle;
      return trim(airframe, place, request);
    };
    double slowest = 1e9, fastest = 0.0, steepest = -1.0, flattest = 1.0;
    for (double v = 0.9 * stall; v < 5.0 * stall; v += 0.1) {
      if (trim(airframe, place, level(v)).ok()) slowest = std::min(slowest, v);
      const auto full = at_power(v, 1.0);
      if (full.ok() && full->climb_rad >= 0.0) fastest = v;
      if (full.ok()) steepest = std::max(steepest, v * std::sin(full->climb_rad));
      const auto idle = at_power(v, 0.0);
      if (idle.ok()) flattest = std::min(flattest, -std::tan(idle->climb_rad));
    }
    const auto cruise = trim(airframe, place, level(testing::cruise_m_s(name)));
    std::printf(
        "[ LIMITS   ] %s: stall %.2f m/s, level flight from %.1f to %.1f m/s, climb %.1f m/s, "
        "glide 1 : %.1f; "
        "at "
        "%.0f m/s angle of attack %.2f deg, elevator %.2f deg, throttle %.3f\n",
        name,
        stall,
        slowest,
        fastest,
        steepest,
        1.0 / flattest,
        testing::cruise_m_s(name),
        deg_from_rad(cruise->alpha_rad),
        deg_from_rad(cruise->controls.elevator_rad),
        cruise->controls.throttle);
    // The elevator's and the thrust's share of the lift moves the slowest flight by a few percent.
    // The Aerosonde's elevator cannot hold the angle of attack of its stall at all.
    const auto slower = trim(airframe, place, level(slowest - 0.2));
    ASSERT_FALSE(slower.ok()) << name;
    if (std::string(name) == "aerosonde") {
      EXPECT_THAT(slower.error().message, HasSubstr("needs elevator -"));
    } else {
      EXPECT_LT(std::abs(slowest / stall - 1.0), 0.06) << name;
      EXPECT_THAT(slower.error().message, HasSubstr("too slow"));
    }
    EXPECT_TRUE(trim(airframe, place, level(fastest)).ok()) << name;
    EXPECT_FALSE(trim(airframe, place, level(fastest + 0.2)).ok()) << name;
    EXPECT_GT(fastest, 2.0 * stall) << name;
    EXPECT_GT(1.0 / flattest, 5.0) << name;
    EXPECT_LT(1.0 / flattest, 20.0) << name;
  }
}

TEST(Trim, SaysWhyAFlightIsImpossible) {
  const Airframe airframe = testing::airframe("piper_cub_third");
  const Environment place;
  const auto reason = [&](const TrimRequest& request) {
    const auto found = trim(airframe, place, request);
    return found.ok() ? std::string("flies") : found.error().message;
  };
  EXPECT_THAT(reason(level(6.0)), HasSubstr("airspeed_m_s = 6: too slow"));
  EXPECT_THAT(reason(level(6.0)), HasSubstr("stall speed with load factor 1 is 9."));
  EXPECT_THAT(reason(level(90.0)), HasSubstr("airspeed_m_s = 90: "));
  EXPECT_THAT(reason(level(90.0)), HasSubstr("thrust"));
  TrimRequest steep = level(20.0);
  steep.climb_rad = rad_from_deg(50.0);
  EXPECT_THAT(reason(steep), HasSubstr("thrust"));
  TrimRequest dive = level(15.0);
  dive.climb_rad = rad_from_deg(-50.0);
  EXPECT_THAT(reason(dive), HasSubstr("without power"));
  TrimRequest banked = level(11.0);
  banked.bank_rad = rad_from_deg(60.0);
  EXPECT_THAT(reason(banked), HasSubstr("too slow"));
  TrimRequest tight = level(25.0);
  tight.radius_m = 2.0;
  EXPECT_THAT(reason(tight), HasSubstr("airspeed_m_s = 25: "));
  EXPECT_EQ(reason(level(0.0)), "airspeed_m_s = 0: must be in (0, 300]");
  TrimRequest over = level(20.0);
  over.bank_rad = 1.5;
  EXPECT_THAT(reason(over), HasSubstr("bank_deg = 85.9"));
  over = level(20.0);
  over.radius_m = 0.5;
  EXPECT_EQ(reason(over), "radius_m = 0.5: must be at least 1 to either side");
  over = level(20.0);
  over.throttle = 1.5;
  EXPECT_EQ(reason(over), "throttle = 1.5: must be in [0, 1]");
  over = level(std::nan(""));
  EXPECT_THAT(reason(over), HasSubstr("must be in (0, 300]"));
}

TEST(Trim, NamesASurfaceThatCannotFollow) {
  Airframe airframe = testing::airframe("aerosonde");
  airframe.elevator.min_rad = rad_from_deg(-1.0);
  const auto found = trim(airframe, {}, level(20.0));
  ASSERT_FALSE(found.ok());
  EXPECT_THAT(found.error().message, HasSubstr("needs elevator -"));
  EXPECT_THAT(found.error().message, HasSubstr("limits are -1 and 30 deg"));
}

TEST(Trim, NeedsTheAirspeedsOfThePaper) {
  // The light airframe flies at 10 m/s, the 50 lb Cub at 20 to 30 m/s, each with margin.
  const Environment place;
  const Airframe light = testing::airframe("foam_trainer");
  const auto slow = trim(light, place, level(10.0));
  ASSERT_TRUE(slow.ok());
  EXPECT_LT(stall_speed_m_s(light, place, 0.0), 8.0);
  EXPECT_LT(slow->controls.throttle, 0.7);
  const Airframe cub = testing::airframe("piper_cub_third");
  for (const double v : {20.0, 25.0, 30.0}) {
    const auto flight = trim(cub, place, level(v));
    ASSERT_TRUE(flight.ok()) << flight.error().message;
    EXPECT_LT(flight->controls.throttle, 0.9);
    EXPECT_LT(std::abs(flight->controls.elevator_rad), rad_from_deg(6.0));
    TrimRequest turn = level(v);
    turn.bank_rad = rad_from_deg(45.0);
    EXPECT_TRUE(trim(cub, place, turn).ok());
  }
}

}  // namespace
}  // namespace overfly::dynamics
