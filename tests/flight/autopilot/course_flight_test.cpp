// The course flown by an airframe: all cells of the accuracy table.
#include "flight/autopilot/course_flight.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tuple>

#include "tests/flight/autopilot/flights.hpp"

namespace overfly::autopilot {
namespace {

using ::testing::HasSubstr;

std::shared_ptr<const HeightQuery> flat() { return std::make_shared<FlatGround>(0.0); }

using Cell = std::tuple<double, double, double>;
class CourseCell : public ::testing::TestWithParam<Cell> {};

TEST_P(CourseCell, FliesInCalmAir) {
  const auto& [airspeed_m_s, rate_deg_s, height_m] = GetParam();
  flight::CourseParameters course;
  course.airspeed_m_s = airspeed_m_s;
  course.roll_rate_max_rad_s = rad_from_deg(rate_deg_s);
  course.height_agl_m = height_m;
  const CourseAircraft aircraft{.airframe = dynamics::testing::airframe(
                                    airspeed_m_s < 15.0 ? "foam_trainer" : "piper_cub_third")};
  const auto truth = fly_course(course, aircraft, {}, flat(), 1).value();
  EXPECT_THAT(truth->warnings(), ::testing::IsEmpty());
  double square = 0.0;
  double fastest = 0.0;
  double flown_m = 0.0;
  int count = 0;
  int reversals = 0;
  double last_bank = 0.0;
  Eigen::Vector3d last = truth->state_at(0).value()->T_world_body.translation;
  Eigen::Vector3d home = last;
  for (std::int64_t t = 0; t <= *truth->duration_ns(); t += 20'000'000, ++count) {
    const AircraftState state = *truth->state_at(t).value();
    const Eigen::Vector3d& position = state.T_world_body.translation;
    square += std::pow(position.z() - height_m, 2);
    fastest = std::max(fastest, std::abs(state.omega_body_rad_s.x()));
    flown_m += (position - last).norm();
    const double bank = attitude_from(state.T_world_body.rotation).roll_rad;
    if (std::abs(bank) > 0.2) {
      if (bank * last_bank < 0.0) ++reversals;
      last_bank = bank;
    }
    last = position;
  }
  testing::print_figure("height RMS [m]", std::sqrt(square / count));
  testing::print_figure("fastest roll over limit", deg_from_rad(fastest) / rate_deg_s);
  EXPECT_LT(std::sqrt(square / count), 3.0);
  EXPECT_LE(deg_from_rad(fastest), 1.05 * rate_deg_s);
  EXPECT_GE(reversals, 5);
  // Turns between waypoints are wider than the planned ones, so the way is up to a sixth longer or
  // shorter; the course ends next to its start, within two of its widest turns (64 m).
  EXPECT_NEAR(flown_m, course.length_m, 0.2 * course.length_m);
  EXPECT_LT((last - home).norm(), 200.0);
}

INSTANTIATE_TEST_SUITE_P(
    Cells,
    CourseCell,
    ::testing::Combine(::testing::Values(10.0, 25.0),
                       ::testing::Values(25.0, 45.0, 65.0),
                       ::testing::Values(50.0, 100.0, 150.0, 200.0, 250.0, 300.0, 350.0, 400.0)),
    [](const auto& cell) {
      return std::to_string(static_cast<int>(std::get<0>(cell.param))) + "ms" +
             std::to_string(static_cast<int>(std::get<1>(cell.param))) + "dps" +
             std::to_string(static_cast<int>(std::get<2>(cell.param))) + "m";
    });

TEST(CourseFlight, TurbulenceMovesTheAircraftAndIsSeeded) {
  flight::CourseParameters course;
  CourseAircraft aircraft{.airframe = dynamics::testing::airframe("piper_cub_third"),
                          .turbulence = dynamics::TurbulenceLevel::kModerate};
  const auto at = [&](std::uint64_t seed) {
    return fly_course(course, aircraft, {}, flat(), seed)
        .value()
        ->state_at(20'000'000'000)
        .value()
        ->T_world_body;
  };
  EXPECT_EQ(at(1).translation, at(1).translation);
  EXPECT_NE(at(1).translation, at(2).translation);
  EXPECT_GT(rotation_angle_rad(at(1).rotation, at(2).rotation), 1e-3);
}

TEST(CourseFlight, ParametersCanBeSetByTheirNames) {
  flight::CourseParameters course;
  CourseAircraft aircraft{.airframe = dynamics::testing::airframe("piper_cub_third")};
  aircraft.parameters = {{"RLL2SRV_TCONST", 0.8}};
  EXPECT_EQ(course_autopilot(course, aircraft, {}, 300.0)->rll2srv_tconst, 0.8);
  aircraft.parameters = {{"RLL2SRV_TCONST", 80.0}};
  EXPECT_THAT(fly_course(course, aircraft, {}, flat(), 1).error().message,
              HasSubstr("RLL2SRV_TCONST = 80: must be in [0.1, 2]"));
  aircraft.parameters = {{"NO_SUCH", 1.0}};
  EXPECT_THAT(fly_course(course, aircraft, {}, flat(), 1).error().message, HasSubstr("NO_SUCH"));
}

TEST(CourseFlight, SaysWhatTheAirframeCannotFly) {
  flight::CourseParameters course;
  course.airspeed_m_s = 10.0;
  CourseAircraft aircraft{.airframe = dynamics::testing::airframe("aerosonde")};
  EXPECT_THAT(fly_course(course, aircraft, {}, flat(), 1).error().message,
              HasSubstr("airspeed_m_s = 10"));
  course.airspeed_m_s = 500.0;
  EXPECT_THAT(fly_course(course, aircraft, {}, flat(), 1).error().message,
              HasSubstr("must be in [5, 80]"));
}

}  // namespace
}  // namespace overfly::autopilot
