// Linear models and modes: published models, closed forms, the nonlinear aircraft, flying
// qualities.
#include "flight/dynamics/modes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "core/motion/pose.hpp"
#include "flight/dynamics/aircraft.hpp"
#include "tests/flight/dynamics/airframes.hpp"

namespace overfly::dynamics {
namespace {

/// The book's air and gravity: 1.2682 kg/m^3 and 9.81 m/s^2.
Environment air_of_the_book() {
  Environment place;
  place.gravity_m_s2 = 9.81;
  double low = -1000.0, high = 0.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (standard_density_kg_m3(middle) > 1.2682 ? low : high) = middle;
  }
  place.alt_msl_at_origin_m = low;
  return place;
}

Trim level_flight(const Airframe& airframe, const Environment& place, double airspeed_m_s) {
  TrimRequest request;
  request.airspeed_m_s = airspeed_m_s;
  return trim(airframe, place, request).value();
}

TEST(LinearModel, OfTheAerosondeIsThatOfThePublishedSolutions) {
  const Airframe airframe = testing::airframe("aerosonde");
  const Environment place = air_of_the_book();
  const Trim flight = level_flight(airframe, place, 25.0);
  const LinearModel model = linearise(airframe, place, flight);
  // Transfer-function coefficients of Beard & McLain, ch. 5, with the supplement's Aerosonde at 25
  // m/s, as several independent solutions of the book's project publish them.
  const double a_phi_1 = 22.628851, a_phi_2 = 130.883678;
  const double a_theta_1 = 5.294738, a_theta_2 = 99.947422, a_theta_3 = -36.112390;
  EXPECT_NEAR(-model.A_lat(1, 1), a_phi_1, 1e-5);
  EXPECT_NEAR(model.B_lat(1, 0), a_phi_2, 1e-4);
  EXPECT_NEAR(-model.A_lon(2, 2), a_theta_1, 1e-5);
  EXPECT_NEAR(model.B_lon(2, 0), a_theta_3, 1e-4);
  // M_alpha = V M_w cos(alpha) - V M_u sin(alpha): a rotation of the velocity at constant speed.
  const double m_alpha = 25.0 * (model.A_lon(2, 1) * std::cos(flight.alpha_rad) -
                                 model.A_lon(2, 0) * std::sin(flight.alpha_rad));
  EXPECT_NEAR(-m_alpha, a_theta_2, 2e-3);
  // The lateral matrix of one of them, states v, p, r and roll. It has no propeller torque, for
  // which this trim slips by 0.3 mrad: 1e-5 of the derivatives.
  const double published[2][3] = {{-3.86674768, -22.6288507, 10.9050408},
                                  {0.783075106, -0.115091677, -1.22765474}};
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 3; ++j) {
      EXPECT_NEAR(model.A_lat(1 + i, j), published[i][j], 2e-5 * std::abs(published[i][j]) + 1e-7);
    }
  }
  EXPECT_NEAR(model.A_lat(0, 0), -0.776772583, 1e-6);
  EXPECT_NEAR(model.B_lat(0, 0), 1.48617188, 1e-6);
  EXPECT_NEAR(model.B_lat(0, 1), 3.76496875, 1e-6);
  EXPECT_NEAR(model.B_lat(1, 1), -1.79637437, 1e-5);
  EXPECT_NEAR(model.B_lat(2, 0), 5.01173501, 1e-5);
  EXPECT_NEAR(model.B_lat(2, 1), -24.88134133, 1e-4);
  // Its trim: u 24.9687 m/s, w 1.24983 m/s, elevator -0.124786 rad, with another model of thrust
  // and drag, which changes the lift that is needed by less than 1 %.
  EXPECT_NEAR(flight.v_body_m_s().z(), 1.24983, 0.012);
  EXPECT_NEAR(flight.controls.elevator_rad, -0.124786, 0.0015);
}

TEST(LinearModel, HasTheClosedFormsOfStraightFlight) {
  for (const char* name : testing::kAirframes) {
    const Airframe a = testing::airframe(name);
    const Environment place;
    const Trim flight = level_flight(a, place, testing::cruise_m_s(name));
    const LinearModel model = linearise(a, place, flight);
    const Eigen::Vector3d v = flight.v_body_m_s();
    const double g = place.gravity_m_s2;
    const double rho = place.density_kg_m3(0.0);
    // Kinematic and gravity terms (Beard & McLain, tables 5.1 and 5.2).
    EXPECT_NEAR(model.A_lon(0, 3), -g * std::cos(flight.pitch_rad), 1e-8);
    EXPECT_NEAR(model.A_lon(1, 3), -g * std::sin(flight.pitch_rad), 1e-8);
    EXPECT_NEAR(model.A_lon(3, 2), 1.0, 1e-9);
    EXPECT_NEAR(model.A_lat(0, 3), g * std::cos(flight.pitch_rad), 1e-8);
    EXPECT_NEAR(model.A_lat(3, 1), 1.0, 1e-9);
    EXPECT_NEAR(model.A_lat(3, 2), std::tan(flight.pitch_rad), 1e-8);
    // Damping derivatives; the propeller's torque is trimmed by a sideslip of up to 4 mrad.
    EXPECT_NEAR(model.A_lon(2, 2),
                0.25 * rho * flight.airspeed_m_s * a.wing.area_m2 * a.wing.chord_m *
                    a.wing.chord_m * a.pitch.pitch_rate / a.inertia.yy,
                1e-5 * std::abs(model.A_lon(2, 2)));
    const double s = 0.5 * rho * flight.airspeed_m_s * a.wing.area_m2 / a.mass_kg;
    EXPECT_NEAR(model.A_lat(0, 0), s * a.side.beta, 2e-5);
    EXPECT_NEAR(model.A_lat(0, 1), v.z() + 0.5 * s * a.wing.span_m * a.side.roll_rate, 1e-6);
    EXPECT_NEAR(model.A_lat(0, 2), -v.x() + 0.5 * s * a.wing.span_m * a.side.yaw_rate, 1e-6);
    // The models are decoupled: no throttle in the pitching moment, no elevator in the roll.
    EXPECT_NEAR(model.B_lon(2, 1), 0.0, 1e-9);
  }
}

/// d/dt x = A x over a time, by small steps.
Eigen::Vector4d linear_flight(const Eigen::Matrix4d& A, Eigen::Vector4d x, double duration_s) {
  const int steps = 20000;
  const double h = duration_s / steps;
  for (int i = 0; i < steps; ++i) {
    const Eigen::Vector4d middle = x + 0.5 * h * (A * x);
    x += h * (A * middle);
  }
  return x;
}

TEST(LinearModel, PredictsSmallDeviationsOfTheAircraft) {
  const double small = 1e-4;
  for (const char* name : testing::kAirframes) {
    AircraftSetup setup;
    setup.airframe = testing::airframe(name);
    const Trim flight = level_flight(setup.airframe, setup.environment, testing::cruise_m_s(name));
    const LinearModel model = linearise(setup.airframe, setup.environment, flight);
    const Eigen::Vector4d lon(1.0 * small, -2.0 * small, 0.1 * small, 0.05 * small);
    const Eigen::Vector4d lat(2.0 * small, 0.2 * small, -0.1 * small, 0.1 * small);
    BodyState start = flight.state({0.0, 0.0, 0.0}, 0.0);
    start.v_body_m_s += Eigen::Vector3d(lon(0), lat(0), lon(1));
    start.omega_body_rad_s += Eigen::Vector3d(lat(1), lon(2), lat(2));
    start.R_world_body = R_world_body_from({lat(3), flight.pitch_rad + lon(3), 0.0});
    Aircraft aircraft = Aircraft::create(setup, start, flight.controls).value();
    const double seconds = 2.0;
    for (int i = 0; i < 800; ++i) EXPECT_TRUE(aircraft.step(flight.controls, seconds / 800).ok());
    const BodyState& end = aircraft.state();
    const RollPitchYaw attitude = attitude_from(end.R_world_body);
    const Eigen::Vector3d dv = end.v_body_m_s - flight.v_body_m_s();
    const Eigen::Vector4d lon_end(
        dv.x(), dv.z(), end.omega_body_rad_s.y(), attitude.pitch_rad - flight.pitch_rad);
    const Eigen::Vector4d lat_end(
        dv.y(), end.omega_body_rad_s.x(), end.omega_body_rad_s.z(), attitude.roll_rad);
    // Each model leaves out the coupling with the other by the sideslip that trims the propeller's
    // torque, below 1 %. A wrong sign of any entry gives more than 10 %.
    EXPECT_LT((lon_end - linear_flight(model.A_lon, lon, seconds)).norm(), 1e-2 * lon.norm())
        << name;
    EXPECT_LT((lat_end - linear_flight(model.A_lat, lat, seconds)).norm(), 1e-2 * lat.norm())
        << name;
  }
}

TEST(Modes, SolveTheirPolynomials) {
  // Blocks with known roots: -2 +- 3 i and -0.1 +- 0.5 i; -1 +- 4 i, -8 and +0.02.
  LinearModel model;
  model.A_lon << -2, 3, 0, 0, -3, -2, 0, 0, 0, 0, -0.1, 0.5, 0, 0, -0.5, -0.1;
  model.A_lat << -1, 4, 0, 0, -4, -1, 0, 0, 0, 0, -8, 0, 0, 0, 0, 0.02;
  Modes found = modes(model);
  EXPECT_NEAR(found.short_period.frequency_rad_s, std::sqrt(13.0), 1e-12);
  EXPECT_NEAR(found.short_period.damping, 2.0 / std::sqrt(13.0), 1e-12);
  EXPECT_NEAR(found.phugoid.frequency_rad_s, std::sqrt(0.26), 1e-12);
  EXPECT_NEAR(found.phugoid.damping, 0.1 / std::sqrt(0.26), 1e-12);
  EXPECT_NEAR(found.dutch_roll->frequency_rad_s, std::sqrt(17.0), 1e-12);
  EXPECT_NEAR(found.roll->rate_1_s, -8.0, 1e-12);
  EXPECT_NEAR(found.spiral->rate_1_s, 0.02, 1e-12);
  // Roll and spiral that have merged into a slow oscillation; a real short period.
  model.A_lat << -1, 4, 0, 0, -4, -1, 0, 0, 0, 0, -0.3, 0.2, 0, 0, -0.2, -0.3;
  model.A_lon << -6, 0, 0, 0, 0, -2, 0, 0, 0, 0, 0.1, 0, 0, 0, 0, -0.2;
  found = modes(model);
  EXPECT_NEAR(found.dutch_roll->frequency_rad_s, std::sqrt(17.0), 1e-12);
  EXPECT_FALSE(found.roll.has_value());
  EXPECT_FALSE(found.spiral.has_value());
  EXPECT_NEAR(found.short_period.damping, 8.0 / (2.0 * std::sqrt(12.0)), 1e-12);
  EXPECT_EQ(found.phugoid.frequency_rad_s, 0.0);
}

/// The Navion of Nelson, Flight Stability and Automatic Control (2nd ed. 1998), appendix B, in
/// level flight at sea level with 176 ft/s. Axes of stability: the angle of attack is zero.
Airframe navion() {
  constexpr double kFt = 0.3048;
  constexpr double kSlugFt2 = 1.3558179483;
  Airframe a = testing::airframe("aerosonde");
  a.mass_kg = 2750.0 * 0.45359237;
  a.inertia = {1048.0 * kSlugFt2, 3000.0 * kSlugFt2, 3530.0 * kSlugFt2, 0.0};
  a.wing = {184.0 * kFt * kFt, 33.4 * kFt, 5.7 * kFt};
  a.lift = {0.41, 4.44, 0.0, 0.0};
  a.pitch = {0.0, -0.683, -9.96, -0.923};
  a.side = {-0.564, 0.0, 0.0, 0.0, 0.157};
  a.roll = {-0.074, -0.410, 0.107, 0.134, 0.0};
  a.yaw = {0.071, -0.0575, -0.125, -0.0035, -0.072};
  // A propeller strong enough, without torque: the textbook's thrust has no moment.
  a.propulsion.diameter_m = 3.0;
  a.propulsion.battery_v = 300.0;
  a.propulsion.torque = {5.23e-7, 4.97e-7, -1.664e-6};
  return a;
}

TEST(Modes, OfTheNavionAreThoseOfTheTextbook) {
  const Airframe airframe = navion();
  const Environment place;
  const Trim flight = level_flight(airframe, place, 176.0 * 0.3048);
  EXPECT_NEAR(flight.alpha_rad, 0.0, 2e-3);
  const Modes found = modes(linearise(airframe, place, flight));
  // Nelson, ch. 5: -0.00877, -8.435, -0.487 +- 2.335 i [1/s].
  EXPECT_NEAR(found.roll->rate_1_s, -8.435, 0.05);
  EXPECT_NEAR(found.dutch_roll->first.real(), -0.487, 0.01);
  EXPECT_NEAR(std::abs(found.dutch_roll->first.imag()), 2.335, 0.02);
  EXPECT_NEAR(found.spiral->rate_1_s, -0.00877, 0.002);
}

TEST(Modes, LieInTheRangesOfFlyingQualities) {
  // MIL-F-8785C, class I, category B, level 1: short period 0.30 <= zeta <= 2.0, phugoid zeta >=
  // 0.04, Dutch roll zeta >= 0.08, zeta omega >= 0.15 and omega >= 0.4, roll mode <= 1.4 s; the
  // spiral doubles in no less than 8 s (level 2) at the scale of a full aircraft, whose times are
  // longer than those of a model by the root of the scale.
  for (const char* name : testing::kAirframes) {
    const Airframe airframe = testing::airframe(name);
    const Environment place;
    const double v = testing::cruise_m_s(name);
    const Modes found = modes(linearise(airframe, place, level_flight(airframe, place, v)));
    ASSERT_TRUE(found.dutch_roll.has_value()) << name;
    ASSERT_TRUE(found.roll.has_value()) << name;
    std::printf(
        "[ MODES    ] %s %.0f m/s: short period %.2f rad/s %.2f, phugoid %.3f rad/s %.3f, Dutch "
        "roll "
        "%.2f rad/s %.3f, roll %.3f s, spiral %.4f 1/s\n",
        name,
        v,
        found.short_period.frequency_rad_s,
        found.short_period.damping,
        found.phugoid.frequency_rad_s,
        found.phugoid.damping,
        found.dutch_roll->frequency_rad_s,
        found.dutch_roll->damping,
        -1.0 / found.roll->rate_1_s,
        found.spiral->rate_1_s);
    EXPECT_GE(found.short_period.damping, 0.30) << name;
    EXPECT_LE(found.short_period.damping, 2.0) << name;
    EXPECT_GE(found.short_period.frequency_rad_s, 3.0) << name;
    EXPECT_GE(found.phugoid.damping, 0.04) << name;
    // Lanchester's sqrt(2) g / V holds for constant energy and incidence. The incidence is not
    // constant by the ratio of the static margin to the manoeuvre margin (Cook, Flight Dynamics
    // Principles, ch. 6).
    const double static_margin = -airframe.pitch.alpha / airframe.lift.alpha;
    const double manoeuvre_margin =
        static_margin - airframe.pitch.pitch_rate * place.density_kg_m3(0.0) *
                            airframe.wing.area_m2 * airframe.wing.chord_m /
                            (4.0 * airframe.mass_kg);
    const double lanchester =
        std::sqrt(2.0 * static_margin / manoeuvre_margin) * place.gravity_m_s2 / v;
    EXPECT_NEAR(found.phugoid.frequency_rad_s / lanchester, 1.0, 0.1) << name;
    EXPECT_GE(found.dutch_roll->damping, 0.08) << name;
    EXPECT_GE(found.dutch_roll->damping * found.dutch_roll->frequency_rad_s, 0.15) << name;
    EXPECT_GE(found.dutch_roll->frequency_rad_s, 0.4) << name;
    EXPECT_LE(-1.0 / found.roll->rate_1_s, 1.4) << name;
    EXPECT_LT(found.roll->rate_1_s, 0.0) << name;
    EXPECT_LT(found.spiral->rate_1_s, std::log(2.0) / 4.0) << name;
  }
}

}  // namespace
}  // namespace overfly::dynamics
