// The whole aircraft: energy, glide, wind, turbulence, tumbling, and what callers read from it.
#include "flight/dynamics/aircraft.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "core/motion/pose.hpp"
#include "flight/dynamics/aerodynamics.hpp"
#include "flight/dynamics/trim.hpp"
#include "tests/flight/dynamics/airframes.hpp"

namespace overfly::dynamics {
namespace {

using ::testing::HasSubstr;

constexpr double kFlightStepS = 1.0 / 400.0;

AircraftSetup setup_of(const std::string& name) {
  AircraftSetup setup;
  setup.airframe = testing::airframe(name);
  return setup;
}

Trim level_trim(const AircraftSetup& setup, double airspeed_m_s, double up_m = 300.0) {
  TrimRequest request;
  request.airspeed_m_s = airspeed_m_s;
  request.up_m = up_m;
  return trim(setup.airframe, setup.environment, request).value();
}

/// An aircraft in level flight to the north.
Aircraft cruising(const AircraftSetup& setup, const Trim& flight) {
  return Aircraft::create(setup,
                          flight.state({0.0, 0.0, flight.up_m}, 0.0, setup.wind_world_m_s),
                          flight.controls)
      .value();
}

double energy_j(const Aircraft& aircraft) {
  const Airframe& a = aircraft.airframe();
  return RigidBody(a.mass_kg, a.inertia, aircraft.environment().gravity_m_s2)
      .energy_j(aircraft.state());
}

TEST(Aircraft, StaysInItsTrim) {
  for (const char* name : testing::kAirframes) {
    const AircraftSetup setup = setup_of(name);
    const Trim flight = level_trim(setup, testing::cruise_m_s(name));
    Aircraft aircraft = cruising(setup, flight);
    for (int i = 0; i < 20 * 400; ++i)
      EXPECT_TRUE(aircraft.step(flight.controls, kFlightStepS).ok());
    // The track differs from the nose by the sideslip that trims the propeller's torque.
    const BodyState start = flight.state({0.0, 0.0, 300.0}, 0.0);
    const Eigen::Vector3d expected =
        start.position_world_m + 20.0 * (start.R_world_body * start.v_body_m_s);
    EXPECT_LT((aircraft.state().position_world_m - expected).norm(), 1e-5) << name;
    EXPECT_LT(std::abs(expected.x()), 0.01 * expected.y()) << name;
    EXPECT_NEAR(expected.z(), 300.0, 1e-6) << name;
  }
}

TEST(Aircraft, KeepsItsEnergyWithoutDragAndThrust) {
  AircraftSetup setup = setup_of("aerosonde");
  Airframe& a = setup.airframe;
  // Lift alone does no work. Without moments the attitude is constant.
  a.drag = {0.0, 1e18, 0.0};
  a.stall = {1.5, 500.0};
  a.pitch = {};
  a.side = a.roll = a.yaw = {};
  a.propulsion.diameter_m = 1e-9;
  BodyState start;
  start.position_world_m = {0.0, 0.0, 1000.0};
  start.R_world_body = R_world_body_from({0.3, 0.1, 0.5});
  start.v_body_m_s = {30.0, 2.0, 3.0};
  Aircraft aircraft = Aircraft::create(setup, start, {}).value();
  const double energy = energy_j(aircraft);
  double slowest = 1e9, fastest = 0.0;
  for (int i = 0; i < 20 * 400; ++i) {
    EXPECT_TRUE(aircraft.step({}, kFlightStepS).ok());
    slowest = std::min(slowest, aircraft.air_data().airspeed_m_s);
    fastest = std::max(fastest, aircraft.air_data().airspeed_m_s);
  }
  EXPECT_NEAR(energy_j(aircraft) / energy, 1.0, 1e-6);
  EXPECT_GT(fastest - slowest, 5.0);  // height and speed were exchanged
}

TEST(Aircraft, GlidesWithTheRatioOfLiftAndDrag) {
  for (const char* name : testing::kAirframes) {
    AircraftSetup setup = setup_of(name);
    setup.airframe.propulsion.diameter_m = 1e-6;  // no propeller
    setup.airframe.lift.elevator = setup.airframe.drag.elevator = 0.0;
    TrimRequest request;
    request.airspeed_m_s = testing::cruise_m_s(name);
    request.throttle = 0.0;
    const Trim glide = trim(setup.airframe, setup.environment, request).value();
    Aircraft aircraft = cruising(setup, glide);
    const Eigen::Vector3d before = aircraft.state().position_world_m;
    for (int i = 0; i < 4; ++i) EXPECT_TRUE(aircraft.step(glide.controls, kFlightStepS).ok());
    const Eigen::Vector3d way = aircraft.state().position_world_m - before;
    const LiftDrag c = lift_drag(setup.airframe, aircraft.air_data().alpha_rad);
    EXPECT_NEAR(-way.head<2>().norm() / way.z() / (c.lift / c.drag), 1.0, 1e-6) << name;
  }
}

TEST(Aircraft, SteadyWindShiftsTheGroundTrackOnly) {
  for (const char* name : testing::kAirframes) {
    AircraftSetup still = setup_of(name);
    const Trim flight = level_trim(still, testing::cruise_m_s(name));
    AircraftSetup windy = still;
    windy.wind_world_m_s = {5.0, -3.0, 0.0};
    Aircraft a = cruising(still, flight);
    Aircraft b = cruising(windy, flight);
    const double seconds = 10.0;
    for (int i = 0; i < static_cast<int>(seconds / kFlightStepS); ++i) {
      Controls commands = flight.controls;
      commands.aileron_rad += 0.03 * std::sin(0.01 * i);
      commands.elevator_rad += 0.02 * std::cos(0.02 * i);
      EXPECT_TRUE(a.step(commands, kFlightStepS).ok());
      EXPECT_TRUE(b.step(commands, kFlightStepS).ok());
    }
    const Eigen::Vector3d drift = b.state().position_world_m - a.state().position_world_m;
    EXPECT_LT((drift - seconds * windy.wind_world_m_s).norm(), 1e-6) << name;
    EXPECT_LT(rotation_angle_rad(a.state().R_world_body, b.state().R_world_body), 1e-9);
    EXPECT_NEAR(a.air_data().airspeed_m_s, b.air_data().airspeed_m_s, 1e-9);
    EXPECT_NEAR(a.air_data().beta_rad, b.air_data().beta_rad, 1e-9);
  }
}

TEST(Aircraft, CrossWindGivesTheDriftAngle) {
  // Wind triangle: nose north, wind from the west: the track turns right by atan(w / V). Without
  // power, so that there is no sideslip.
  AircraftSetup setup = setup_of("aerosonde");
  setup.airframe.propulsion.diameter_m = 1e-6;
  setup.wind_world_m_s = {8.0, 0.0, 0.0};
  TrimRequest request;
  request.airspeed_m_s = 25.0;
  request.throttle = 0.0;
  const Trim flight = trim(setup.airframe, setup.environment, request).value();
  Aircraft aircraft = cruising(setup, flight);
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(aircraft.step(flight.controls, kFlightStepS).ok());
  const AircraftState truth = aircraft.truth(0);
  EXPECT_NEAR(std::atan2(truth.v_body_world_m_s.x(), truth.v_body_world_m_s.y()),
              std::atan(8.0 / (25.0 * std::cos(flight.climb_rad))),
              1e-6);
  EXPECT_NEAR(attitude_from(truth.T_world_body.rotation).yaw_rad, 0.0, 1e-9);
}

TEST(Aircraft, SurvivesEveryTumbleAndFallsSlowerThanItsTerminalSpeed) {
  std::mt19937_64 generator(12);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(generator() >> 11U) * 0x1.0p-53;
  };
  for (const char* name : testing::kAirframes) {
    AircraftSetup setup = setup_of(name);
    // Straight down at zero lift: the fastest fall there is.
    const double terminal =
        std::sqrt(2.0 * setup.airframe.mass_kg * 9.80665 /
                  (standard_density_kg_m3(5000.0) * setup.airframe.wing.area_m2 *
                   std::max(0.01, setup.airframe.drag.parasite)));
    for (int k = 0; k < 40; ++k) {
      BodyState start;
      start.position_world_m = {0.0, 0.0, 5000.0};
      start.R_world_body = R_world_body_from(
          {uniform(-kPi, kPi), uniform(-0.5 * kPi, 0.5 * kPi), uniform(-kPi, kPi)});
      const double speed = k % 4 == 0 ? 0.0 : uniform(0.0, 40.0);
      start.v_body_m_s =
          speed * Eigen::Vector3d(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)).normalized();
      start.omega_body_rad_s = {uniform(-15, 15), uniform(-15, 15), uniform(-15, 15)};
      const Controls held{uniform(-0.4, 0.4), uniform(-0.4, 0.4), uniform(-0.4, 0.4), 0.0};
      Aircraft aircraft = Aircraft::create(setup, start, held).value();
      const double energy_start = energy_j(aircraft);
      for (int i = 0; i < 30 * 400; ++i) {
        EXPECT_TRUE(aircraft.step(held, kFlightStepS).ok());
        const BodyState& state = aircraft.state();
        ASSERT_TRUE(state.position_world_m.allFinite() && state.v_body_m_s.allFinite() &&
                    state.omega_body_rad_s.allFinite());
        ASSERT_NEAR(state.R_world_body.norm(), 1.0, 1e-12);
      }
      EXPECT_LT(aircraft.air_data().airspeed_m_s, 1.1 * terminal) << name << ' ' << k;
      EXPECT_LT(aircraft.state().omega_body_rad_s.norm(), 60.0) << name << ' ' << k;
      EXPECT_LT(energy_j(aircraft), energy_start) << name << ' ' << k;
    }
  }
}

TEST(Aircraft, TailSlideEndsNoseDown) {
  for (const char* name : testing::kAirframes) {
    const AircraftSetup setup = setup_of(name);
    BodyState start;
    start.position_world_m = {0.0, 0.0, 3000.0};
    start.R_world_body = R_world_body_from({0.0, rad_from_deg(89.0), 0.0});
    Aircraft aircraft = Aircraft::create(setup, start, {}).value();
    double lowest_pitch = 1.0, forward = -1e9;
    for (int i = 0; i < 20 * 400; ++i) {
      EXPECT_TRUE(aircraft.step({}, kFlightStepS).ok());
      lowest_pitch = std::min(lowest_pitch, attitude_from(aircraft.state().R_world_body).pitch_rad);
      forward = std::max(forward, aircraft.state().v_body_m_s.x());
    }
    EXPECT_LT(lowest_pitch, rad_from_deg(-30.0)) << name;
    EXPECT_GT(forward, 8.0) << name;
  }
}

TEST(Aircraft, ConvergesWithTheStep) {
  const AircraftSetup setup = setup_of("foam_trainer");
  const Trim flight = level_trim(setup, 10.0);
  const auto end_of = [&](double dt_s) {
    Aircraft aircraft = cruising(setup, flight);
    // A bank of 60 deg and back, from commands that are constant over 0.5 s.
    for (int piece = 0; piece < 8; ++piece) {
      Controls commands = flight.controls;
      commands.aileron_rad += piece < 2 ? 0.15 : piece < 4 ? -0.15 : 0.05;
      const auto steps = static_cast<int>(std::lround(0.5 / dt_s));
      for (int i = 0; i < steps; ++i) EXPECT_TRUE(aircraft.step(commands, dt_s).ok());
    }
    return aircraft.state();
  };
  const BodyState exact = end_of(1.0 / 6400.0);
  const auto error = [&](double dt_s) {
    return (end_of(dt_s).position_world_m - exact.position_world_m).norm();
  };
  EXPECT_LT(error(1.0 / 400.0), 1e-4);
  EXPECT_LT(error(1.0 / 100.0), 5e-3);
}

TEST(Aircraft, IsAFunctionOfItsInput) {
  AircraftSetup setup = setup_of("foam_trainer");
  setup.turbulence = TurbulenceLevel::kSevere;
  setup.turbulence_seed = 77;
  const Trim flight = level_trim(setup, 10.0);
  Aircraft a = cruising(setup, flight);
  Aircraft b = cruising(setup, flight);
  setup.turbulence_seed = 78;
  Aircraft c = cruising(setup, flight);
  for (int i = 0; i < 4000; ++i) {
    for (Aircraft* aircraft : {&a, &b, &c})
      EXPECT_TRUE(aircraft->step(flight.controls, kFlightStepS).ok());
  }
  EXPECT_EQ(a.state().position_world_m, b.state().position_world_m);
  EXPECT_EQ(a.state().R_world_body.coeffs(), b.state().R_world_body.coeffs());
  EXPECT_EQ(a.state().omega_body_rad_s, b.state().omega_body_rad_s);
  EXPECT_NE(a.state().position_world_m, c.state().position_world_m);
}

TEST(Aircraft, OneStepIsThatOfItsParts) {
  AircraftSetup setup = setup_of("piper_cub_third");
  setup.wind_world_m_s = {2.0, -1.0, 0.3};
  setup.turbulence = TurbulenceLevel::kSevere;
  setup.turbulence_seed = 5;
  setup.environment.alt_msl_at_origin_m = 1500.0;
  setup.environment.ground_up_m = 100.0;
  BodyState start;
  start.position_world_m = {0.0, 0.0, 250.0};
  start.R_world_body = R_world_body_from({0.3, 0.1, rad_from_deg(70.0)});
  start.v_body_m_s = {24.0, 1.0, 1.5};
  start.omega_body_rad_s = {0.2, -0.1, 0.3};
  const Controls positions{0.05, -0.1, 0.02, 0.5};
  const Controls commands{-0.2, 0.2, -0.1, 0.9};
  const double dt_s = 0.005;
  Aircraft aircraft = Aircraft::create(setup, start, positions).value();
  EXPECT_TRUE(aircraft.step(commands, dt_s).ok());

  // The same gusts, met along the horizontal airspeed 150 m above the ground.
  Turbulence air(TurbulenceLevel::kSevere, setup.airframe.wing.span_m, 5);
  const Eigen::Vector3d through = start.R_world_body * start.v_body_m_s - setup.wind_world_m_s;
  air.advance(through.norm(), 150.0, 0.0);
  air.advance(through.norm(), 150.0, dt_s);
  const double heading = std::atan2(through.x(), through.y());
  const Eigen::Vector3d& gust = air.gust().velocity_m_s;
  const Eigen::Vector3d air_world =
      setup.wind_world_m_s + gust.x() * Eigen::Vector3d(std::sin(heading), std::cos(heading), 0.0) +
      gust.y() * Eigen::Vector3d(std::cos(heading), -std::sin(heading), 0.0) -
      gust.z() * Eigen::Vector3d::UnitZ();
  EXPECT_LT((aircraft.air_velocity_world_m_s() - air_world).norm(), 1e-12);
  const RigidBody body(setup.airframe.mass_kg, setup.airframe.inertia, kStandardGravityMS2);
  const BodyState expected = body.step(start, dt_s, [&](const BodyState& at, double fraction) {
    return air_wrench(setup.airframe,
                      at.v_body_m_s - at.R_world_body.conjugate() * air_world,
                      at.omega_body_rad_s - air.gust().rate_rad_s,
                      advance(positions, commands, setup.airframe, fraction * dt_s),
                      standard_density_kg_m3(1500.0 + at.position_world_m.z()));
  });
  EXPECT_LT((aircraft.state().position_world_m - expected.position_world_m).norm(), 1e-12);
  EXPECT_LT((aircraft.state().v_body_m_s - expected.v_body_m_s).norm(), 1e-12);
  EXPECT_LT((aircraft.state().omega_body_rad_s - expected.omega_body_rad_s).norm(), 1e-12);
  EXPECT_GT(air.gust().rate_rad_s.norm(), 1e-3);
  EXPECT_GT(gust.norm(), 0.5);
}

TEST(Aircraft, TurbulenceShakesTheAirAroundTheSteadyWind) {
  AircraftSetup setup = setup_of("piper_cub_third");
  setup.wind_world_m_s = {4.0, 1.0, 0.0};
  setup.turbulence = TurbulenceLevel::kLight;
  const Trim flight = level_trim(setup, 25.0);
  Aircraft aircraft = cruising(setup, flight);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  int count = 0;
  for (int i = 0; i < 400 * 400; ++i) {
    EXPECT_TRUE(aircraft.step(flight.controls, kFlightStepS).ok());
    if (i % 400 == 0) {
      const Eigen::Vector3d gust = aircraft.air_velocity_world_m_s() - setup.wind_world_m_s;
      sum += gust;
      squares += gust.cwiseAbs2();
      ++count;
    }
  }
  // Light turbulence: 0.77 m/s vertical near the ground, up to 2 m/s high up.
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LT(std::abs(sum(axis) / count), 1.0);
    EXPECT_GT(std::sqrt(squares(axis) / count), 0.3);
    EXPECT_LT(std::sqrt(squares(axis) / count), 2.5);
  }
}

TEST(Aircraft, LongStepsAtHighRatesAreDivided) {
  // Damping of 500 / s at 200 m/s: undivided steps of 0.02 s would diverge.
  const AircraftSetup setup = setup_of("foam_trainer");
  BodyState start;
  start.position_world_m.z() = 2000.0;
  start.v_body_m_s = {200.0, 20.0, 10.0};
  start.omega_body_rad_s = {80.0, 30.0, 30.0};
  Aircraft aircraft = Aircraft::create(setup, start, {}).value();
  for (int i = 0; i < 500; ++i) EXPECT_TRUE(aircraft.step({}, kStepMaxS).ok());
  EXPECT_TRUE(aircraft.state().position_world_m.allFinite());
  EXPECT_LT(aircraft.air_data().airspeed_m_s, 60.0);
  EXPECT_LT(aircraft.state().omega_body_rad_s.norm(), 20.0);
}

/// A side force that grows with the yaw rate adds energy without a limit.
TEST(Aircraft, AMotionThatDivergesIsAnError) {
  AircraftSetup setup = setup_of("foam_trainer");
  setup.airframe.mass_kg = 0.2;
  setup.airframe.side.yaw_rate = 1.23065;
  setup.airframe.side.rudder = 1.18102;
  setup.airframe.lift.zero = 1.46338;
  setup.airframe.yaw.yaw_rate = 0.5;
  BodyState start;
  start.v_body_m_s = {20.0, 3.0, -4.0};
  start.omega_body_rad_s = {5.0, -3.0, 2.0};
  Aircraft aircraft = Aircraft::create(setup, start, {0.0, 0.0, 0.0, 1.0}).value();
  Status status;
  for (int i = 0; i < 1000 && status; ++i) status = aircraft.step({0.3, -0.3, 0.3, 1.0}, 0.01);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::kInvalidArgument);
  EXPECT_NE(status.error().message.find("a coefficient adds energy"), std::string::npos);
  // The state stays the last good one, and so does the error.
  EXPECT_LE(aircraft.state().v_body_m_s.norm(), kSpeedMaxMS);
  EXPECT_LE(aircraft.state().omega_body_rad_s.norm(), kRateMaxRadS);
  EXPECT_FALSE(aircraft.step({}, 0.01).ok());
}

TEST(Aircraft, TellsItsTruth) {
  AircraftSetup setup = setup_of("aerosonde");
  setup.wind_world_m_s = {3.0, 4.0, -0.5};
  BodyState start;
  start.position_world_m = {10.0, 20.0, 30.0};
  start.R_world_body = R_world_body_from({0.2, 0.1, 1.0});
  start.v_body_m_s = {22.0, 1.0, 2.0};
  start.omega_body_rad_s = {0.1, 0.2, 0.3};
  const Aircraft aircraft = Aircraft::create(setup, start, {0.0, 0.0, 0.0, 0.5}).value();
  const AircraftState truth = aircraft.truth(1234);
  EXPECT_EQ(truth.t_ns, 1234);
  EXPECT_EQ(truth.T_world_body.translation, start.position_world_m);
  const Eigen::Vector3d v = start.R_world_body * start.v_body_m_s;
  EXPECT_LT((truth.v_body_world_m_s - v).norm(), 1e-12);
  EXPECT_EQ(truth.omega_body_rad_s, start.omega_body_rad_s);
  EXPECT_NEAR(truth.airspeed_m_s, (v - setup.wind_world_m_s).norm(), 1e-12);
  EXPECT_EQ(aircraft.positions().throttle, 0.5);
}

TEST(Aircraft, RejectsImpossibleStarts) {
  const AircraftSetup setup = setup_of("aerosonde");
  const auto complaint = [](const AircraftSetup& with, const BodyState& start) {
    const auto aircraft = Aircraft::create(with, start, {});
    return aircraft.ok() ? std::string() : aircraft.error().message;
  };
  BodyState start;
  EXPECT_EQ(complaint(setup, start), "");
  start.v_body_m_s = {400.0, 0.0, 0.0};
  EXPECT_EQ(complaint(setup, start), "start.speed_m_s = 400: must be at most 300");
  start.v_body_m_s = {std::nan(""), 0.0, 0.0};
  EXPECT_THAT(complaint(setup, start), HasSubstr("start.speed_m_s = nan"));
  start = {};
  start.R_world_body.coeffs() *= 1.1;
  EXPECT_THAT(complaint(setup, start), HasSubstr("start.attitude_norm_error = 0.1"));
  start = {};
  start.omega_body_rad_s.x() = 101.0;
  EXPECT_THAT(complaint(setup, start), HasSubstr("start.rate_rad_s = 101"));
  AircraftSetup stormy = setup;
  stormy.wind_world_m_s.x() = 200.0;
  EXPECT_THAT(complaint(stormy, {}), HasSubstr("wind_m_s = 200: must be at most 100"));
  AircraftSetup heavy = setup;
  heavy.environment.gravity_m_s2 = -1.0;
  EXPECT_THAT(complaint(heavy, {}), HasSubstr("gravity_m_s2 = -1"));
}

}  // namespace
}  // namespace overfly::dynamics
