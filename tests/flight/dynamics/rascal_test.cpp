// A recorded flight of another simulator's aircraft (a Rascal 110 with an autopilot, 290 s of
// straight legs and turns without wind, 20 Hz): its motion must fit this room's conventions and
// kinematics. The aircraft's own forces are not compared: its coefficients belong to that
// simulator.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "core/earth/geodesy.hpp"
#include "core/motion/pose.hpp"
#include "flight/dynamics/aircraft.hpp"
#include "flight/dynamics/environment.hpp"
#include "flight/dynamics/rigid_body.hpp"
#include "tests/flight/dynamics/airframes.hpp"
#include "tests/support/support.hpp"

namespace overfly::dynamics {
namespace {

using overfly::testing::larger_error;

constexpr double kMetrePerFoot = 0.3048;

struct Row {
  double t_s;
  Geodetic place;
  RollPitchYaw attitude;
  BodyState state;  // position in the world frame of the first row
  double airspeed_m_s, alpha_rad, beta_rad;
};

std::vector<Row> read_rows(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  std::vector<Row> rows;
  std::optional<LocalFrame> frame;
  while (std::getline(in, line)) {
    std::array<double, 16> x{};
    std::istringstream fields(line);
    std::string field;
    for (double& value : x) {
      std::getline(fields, field, ',');
      value = std::stod(field);
    }
    Row row{x[0],
            geodetic_from_deg(x[1], x[2], x[3]),
            {x[7], x[8], x[9]},
            {},
            x[13] * kMetrePerFoot,
            x[14],
            x[15]};
    if (!frame) frame.emplace(row.place);
    // Attitude and velocity are relative to the local horizon of each row.
    const Eigen::Quaterniond R_world_local = frame->R_world_enu_at(row.place);
    row.state.position_world_m = frame->world_from_geodetic(row.place);
    row.state.R_world_body = R_world_local * R_world_body_from(row.attitude);
    const Eigen::Vector3d v_local = kMetrePerFoot * Eigen::Vector3d(x[5], x[4], -x[6]);
    row.state.v_body_m_s = row.state.R_world_body.conjugate() * (R_world_local * v_local);
    row.state.omega_body_rad_s = {x[10], x[11], x[12]};
    rows.push_back(row);
  }
  return rows;
}

TEST(RecordedRascal, AirDataFollowFromVelocityAndAttitude) {
  OVERFLY_DATA_OR_SKIP(file, "jsbsim/rascal_25ms_20hz.csv");
  const auto rows = read_rows(file);
  ASSERT_GT(rows.size(), 5000U);
  AircraftSetup setup;
  setup.airframe = testing::airframe("aerosonde");
  double worst_speed = 0.0, worst_angle = 0.0;
  for (const Row& row : rows) {
    const AirData air = Aircraft::create(setup, row.state, {})->air_data();
    worst_speed = larger_error(worst_speed, std::abs(air.airspeed_m_s - row.airspeed_m_s));
    worst_angle = larger_error(worst_angle, std::abs(air.alpha_rad - row.alpha_rad));
    worst_angle = larger_error(worst_angle, std::abs(air.beta_rad - row.beta_rad));
  }
  RecordProperty("worst_speed_m_s", std::to_string(worst_speed));
  RecordProperty("worst_angle_rad", std::to_string(worst_angle));
  // The file has seven digits.
  EXPECT_LT(worst_speed, 1e-5);
  EXPECT_LT(worst_angle, 3e-6);
}

TEST(RecordedRascal, IntegratedRatesGiveItsAttitudesAndPositions) {
  OVERFLY_DATA_OR_SKIP(file, "jsbsim/rascal_25ms_20hz.csv");
  const auto rows = read_rows(file);
  // A body without resistance to turning: moments and forces prescribe the recorded rates and
  // velocities, linear between the rows.
  const RigidBody body(1.0, {1.0, 1.0, 1.0, 0.0}, 0.0);
  constexpr std::size_t kWindow = 200;  // 10 s
  double worst_angle = 0.0, worst_place_m = 0.0;
  for (std::size_t start = 0; start + kWindow < rows.size(); start += kWindow) {
    BodyState state = rows[start].state;
    for (std::size_t i = start; i < start + kWindow; ++i) {
      const BodyState& from = rows[i].state;
      const BodyState& to = rows[i + 1].state;
      const double dt_s = rows[i + 1].t_s - rows[i].t_s;
      state.omega_body_rad_s = from.omega_body_rad_s;
      state.v_body_m_s = from.v_body_m_s;
      state = body.step(state, dt_s, [&](const BodyState& at, double /*fraction*/) {
        return Wrench{
            (to.v_body_m_s - from.v_body_m_s) / dt_s + at.omega_body_rad_s.cross(at.v_body_m_s),
            (to.omega_body_rad_s - from.omega_body_rad_s) / dt_s};
      });
    }
    const BodyState& end = rows[start + kWindow].state;
    worst_angle =
        larger_error(worst_angle, rotation_angle_rad(state.R_world_body, end.R_world_body));
    worst_place_m =
        larger_error(worst_place_m, (state.position_world_m - end.position_world_m).norm());
  }
  RecordProperty("worst_angle_rad", std::to_string(worst_angle));
  RecordProperty("worst_place_m", std::to_string(worst_place_m));
  // Rates and velocities are not linear within 50 ms while the bank changes.
  EXPECT_LT(worst_angle, 2e-3);
  EXPECT_LT(worst_place_m, 0.2);
}

TEST(RecordedRascal, TurnsByBankAndSideForce) {
  OVERFLY_DATA_OR_SKIP(file, "jsbsim/rascal_25ms_20hz.csv");
  const auto rows = read_rows(file);
  const double g = Environment::at(rows.front().place, 0.0).gravity_m_s2;
  int steady = 0, left = 0;
  double least = 1e9, most = -1e9, worst_rate = 0.0, least_turn = 1e9, most_turn = -1e9;
  constexpr std::size_t kSecond = 20;
  for (std::size_t i = kSecond; i + kSecond < rows.size(); ++i) {
    const Row& row = rows[i];
    const double roll = row.attitude.roll_rad;
    const auto steady_at = [&](std::size_t j) {
      return std::abs(rows[j].attitude.roll_rad - roll) < 0.02;
    };
    if (std::abs(roll) < 0.4 || !steady_at(i - kSecond) || !steady_at(i + kSecond)) continue;
    ++steady;
    if (roll < 0.0) ++left;
    const double turn_rate = wrap_pi(rows[i + 1].attitude.yaw_rad - rows[i - 1].attitude.yaw_rad) /
                             (rows[i + 1].t_s - rows[i - 1].t_s);
    const Eigen::Vector3d& omega = row.state.omega_body_rad_s;
    const Eigen::Vector3d& v = row.state.v_body_m_s;
    // Beard & McLain, eq. 3.3.
    const double by_rates = (omega.y() * std::sin(roll) + omega.z() * std::cos(roll)) /
                            std::cos(row.attitude.pitch_rad);
    worst_rate = larger_error(worst_rate, std::abs(turn_rate / by_rates - 1.0));
    const double turn = turn_rate * row.airspeed_m_s / (g * std::tan(roll));
    least_turn = std::min(least_turn, turn);
    most_turn = std::max(most_turn, turn);
    // The equation of motion of v: what gravity and rotation leave is the air's side force.
    const double v_rate = (rows[i + 1].state.v_body_m_s.y() - rows[i - 1].state.v_body_m_s.y()) /
                          (rows[i + 1].t_s - rows[i - 1].t_s);
    const double side_force = v_rate + omega.z() * v.x() - omega.x() * v.z() -
                              g * std::sin(roll) * std::cos(row.attitude.pitch_rad);
    least = std::min(least, side_force / row.beta_rad);
    most = std::max(most, side_force / row.beta_rad);
  }
  std::printf(
      "[ RASCAL   ] %d rows of steady turns: turn rate over g tan(bank) / V %.3f to %.3f, side "
      "force "
      "over sideslip %.1f to %.1f m/s^2, turn rate by p, q, r within %.4f\n",
      steady,
      least_turn,
      most_turn,
      least,
      most,
      worst_rate);
  ASSERT_GT(steady, 100);
  EXPECT_GT(left, 0);
  EXPECT_LT(worst_rate, 0.01);
  // The turns are not quite coordinated: sideslips of 0.5 deg to the right and 0.8 deg to the left
  // carry up to an eighth of the turn. If they do, one derivative of the side force explains every
  // row; with C_Y_beta = -0.9 (the Aerosonde: -0.98), 25 m/s and 60 N/m^2 of wing loading it is
  // -57.
  EXPECT_GT(least_turn, 0.87);
  EXPECT_LT(most_turn, 1.0);
  EXPECT_GT(least, -61.0);
  EXPECT_LT(most, -55.0);
}

}  // namespace
}  // namespace overfly::dynamics
