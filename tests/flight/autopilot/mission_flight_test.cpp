// Whole missions: lines, circles, wind, turbulence, take-off, landing, terrain, bad input.
#include "flight/autopilot/mission_flight.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "core/time.hpp"
#include "flight/autopilot/mission_preview.hpp"
#include "flight/dynamics/trim.hpp"
#include "tests/flight/autopilot/flights.hpp"
#include "tests/support/support.hpp"

namespace overfly::autopilot {
namespace {

using overfly::testing::larger_error;
using testing::fly;
using ::testing::HasSubstr;
using testing::item_of;
using testing::print_figure;
using testing::setup_of;
using testing::t_s;
using testing::waypoint;

constexpr const char* kNames[] = {"foam_trainer", "piper_cub_third"};

TEST(MissionFlight, HoldsHeightAndTrackOverASquareInWind) {
  for (const char* name : kNames) {
    MissionSetup setup = setup_of(name);
    const double wind = 0.3 * setup.parameters.airspeed_cruise;
    setup.wind_world_m_s = {wind, 0.0, 0.0};
    setup.mission.items = {waypoint(0, 1500, 300),
                           waypoint(1500, 1500, 300),
                           waypoint(1500, 0, 300),
                           waypoint(0, 0, 300)};
    double off_m = 0.0;
    double square = 0.0;
    double begun_s = 0.0;
    std::size_t item = 0;
    int count = 0;
    const MissionFlight flight = fly(setup, [&](const MissionFlight& at) {
      const double height = at.aircraft().state().position_world_m.z() - 300.0;
      square += height * height;
      ++count;
      const MissionPilot& pilot = at.autopilot().pilot();
      if (pilot.item() != item) {
        item = pilot.item();
        begun_s = t_s(at);
      }
      // Captured: three periods of the guidance after the turn.
      if (t_s(at) > begun_s + 3.0 * setup.parameters.navl1_period) {
        off_m = larger_error(off_m, std::abs(pilot.cross_track_m()));
      }
      return true;
    });
    print_figure(std::string(name) + ", square in wind: height RMS [m]", std::sqrt(square / count));
    print_figure(std::string(name) + ", square in wind: largest cross-track [m]", off_m);
    EXPECT_EQ(flight.end(), FlightEnd::kMissionDone) << name;
    EXPECT_LT(off_m, 5.0) << name;
    EXPECT_LT(std::sqrt(square / count), 3.0) << name;
    // All four sides: 6 km over ground.
    EXPECT_GT(t_s(flight), 5500.0 / (1.3 * setup.parameters.airspeed_cruise)) << name;
  }
}

TEST(MissionFlight, LeavesACircleAtItsHeightTowardsTheNextItem) {
  for (const char* name : kNames) {
    MissionSetup setup = setup_of(name);
    MissionItem circle = item_of(MissionCommand::kLoiter, waypoint(0, 800, 360));
    circle.radius_m = 100.0;
    circle.until_height = true;
    setup.mission.items = {circle, waypoint(2000, 800, 360)};
    double left_at_m = 0.0;
    double course_deg = 0.0;
    const MissionFlight flight = fly(setup, [&](const MissionFlight& at) {
      if (at.autopilot().pilot().item() == 1 && left_at_m == 0.0) {
        const FlightState state = flight_state(at.aircraft());
        left_at_m = state.position_world_m.z();
        const Eigen::Vector2d way(2000.0 - state.position_world_m.x(),
                                  800.0 - state.position_world_m.y());
        course_deg = deg_from_rad(
            std::abs(wrap_pi(std::atan2(way.x(), way.y()) -
                             std::atan2(state.v_world_m_s.x(), state.v_world_m_s.y()))));
      }
      return true;
    });
    EXPECT_EQ(flight.end(), FlightEnd::kMissionDone) << name;
    EXPECT_NEAR(left_at_m, 360.0, 6.0) << name;
    EXPECT_LT(course_deg, 10.5) << name;
  }
}

TEST(MissionFlight, StaysInTheAirForAnHourOfModerateTurbulence) {
  for (const char* name : kNames) {
    MissionSetup setup = setup_of(name);
    setup.turbulence = dynamics::TurbulenceLevel::kModerate;
    setup.duration_max_s = 3600.0;
    setup.mission.items = {item_of(MissionCommand::kLoiter, waypoint(0, 200, 300))};
    double lowest = 1e9;
    double highest = 0.0;
    double square = 0.0;
    int count = 0;
    const MissionFlight flight = fly(setup, [&](const MissionFlight& at) {
      const double up_m = at.aircraft().state().position_world_m.z();
      lowest = std::min(lowest, up_m);
      highest = std::max(highest, up_m);
      square += (up_m - 300.0) * (up_m - 300.0);
      ++count;
      return true;
    });
    print_figure(std::string(name) + ", an hour of moderate turbulence: height RMS [m]",
                 std::sqrt(square / count));
    print_figure(std::string(name) + ", the same: largest height error [m]",
                 std::max(300.0 - lowest, highest - 300.0));
    EXPECT_LT(std::sqrt(square / count), 3.0) << name;
    EXPECT_EQ(flight.end(), FlightEnd::kTimeLimit) << name;
    EXPECT_DOUBLE_EQ(t_s(flight), 3600.0);
    EXPECT_GT(lowest, 250.0) << name;
    EXPECT_LT(highest, 350.0) << name;
  }
}

TEST(MissionFlight, BanksLessInThinAir) {
  MissionSetup setup = setup_of("foam_trainer");
  setup.environment.alt_msl_at_origin_m = 2500.0;
  setup.parameters = tuned_for(setup.airframe, setup.environment, 10.0, 300.0).value();
  MissionItem circle = item_of(MissionCommand::kLoiter, waypoint(0, 60, 300));
  circle.radius_m = 5.0;  // far less than it can fly
  setup.mission.items = {circle};
  setup.duration_max_s = 40.0;
  const StallSpeed stall(setup.airframe, setup.environment);
  EXPECT_NEAR(stall.at_m_s(300.0),
              dynamics::stall_speed_m_s(setup.airframe, setup.environment, 300.0),
              1e-9);
  double beyond_rad = -kPi;
  fly(setup, [&](const MissionFlight& at) {
    const FlightState state = flight_state(at.aircraft());
    const double limit =
        bank_limit_rad(stall.at_m_s(state.position_world_m.z()), state.airspeed_m_s);
    beyond_rad = std::max(beyond_rad, std::abs(state.attitude.roll_rad) - limit);
    return true;
  });
  EXPECT_NEAR(deg_from_rad(beyond_rad), 0.0, 4.0);
  beyond_rad = -kPi;
  const MissionPreview preview = preview_mission(setup, std::make_shared<FlatGround>(0.0)).value();
  for (const PreviewState& state : preview.states) {
    const double limit =
        bank_limit_rad(stall.at_m_s(state.position_world_m.z()), state.airspeed_m_s);
    beyond_rad = std::max(beyond_rad, std::abs(state.attitude.roll_rad) - limit);
  }
  EXPECT_NEAR(deg_from_rad(beyond_rad), 0.0, 1.0);
}

TEST(MissionFlight, LoitersForTurnsAndForTime) {
  MissionSetup setup = setup_of("piper_cub_third");
  MissionItem turns = item_of(MissionCommand::kLoiter, waypoint(300, 500, 300));
  turns.turns = 3.0;
  turns.radius_m = -150.0;
  MissionItem timed = item_of(MissionCommand::kLoiter, waypoint(300, 500, 300));
  timed.radius_m = -150.0;
  timed.time_s = 40.0;
  setup.mission.items = {turns, timed, waypoint(300, 2000, 300)};
  std::vector<double> begun_s(4, 0.0);
  double off_m = 0.0;
  const MissionFlight flight = fly(setup, [&](const MissionFlight& at) {
    const std::size_t item = at.autopilot().pilot().item();
    if (item < begun_s.size() && begun_s[item] == 0.0) begun_s[item] = t_s(at);
    if (item == 1) off_m = larger_error(off_m, std::abs(at.autopilot().pilot().cross_track_m()));
    return true;
  });
  ASSERT_EQ(flight.end(), FlightEnd::kMissionDone);
  const double period_s = 2.0 * kPi * 150.0 / 25.0;
  EXPECT_GT(begun_s[1], 3.0 * period_s);
  EXPECT_LT(begun_s[1], 3.0 * period_s + 35.0);  // on the way there
  EXPECT_NEAR(begun_s[2] - begun_s[1], 40.0, 0.1);
  EXPECT_LT(off_m, 3.0);
}

TEST(MissionFlight, TakesOffReturnsAndLands) {
  for (const char* name : kNames) {
    MissionSetup setup = setup_of(name);
    setup.start_world_m.reset();
    setup.wind_world_m_s = {0.0, -2.0, 0.0};
    const double v = setup.parameters.airspeed_cruise;
    setup.mission.items = {item_of(MissionCommand::kTakeOff, waypoint(0, 300, 60)),
                           waypoint(0, 60 * v, 80),
                           waypoint(40 * v, 60 * v, 80),
                           waypoint(40 * v, 0, 40),
                           item_of(MissionCommand::kLand, waypoint(0, 0, 0))};
    double lowest_after_climb = 1e9;
    double sink_m_s = 0.0;
    const MissionFlight flight = fly(setup, [&](const MissionFlight& at) {
      const FlightState state = flight_state(at.aircraft());
      if (at.autopilot().pilot().phase() == FlightPhase::kEnRoute) {
        lowest_after_climb = std::min(lowest_after_climb, state.position_world_m.z());
      }
      sink_m_s = -state.v_world_m_s.z();
      return true;
    });
    print_figure(std::string(name) + ", landing: sink at contact [m/s]", sink_m_s);
    print_figure(std::string(name) + ", landing: distance from the point [m]",
                 flight.aircraft().state().position_world_m.head<2>().norm());
    EXPECT_EQ(flight.end(), FlightEnd::kLanded) << name << " " << t_s(flight);
    EXPECT_GT(lowest_after_climb, 35.0) << name;
    EXPECT_LT(sink_m_s, 1.5) << name;
    const Eigen::Vector3d& at = flight.aircraft().state().position_world_m;
    EXPECT_LT(at.head<2>().norm(), 8.0 * v) << name << " " << at.transpose();
  }
}

TEST(MissionFlight, ReturnsHomeAndCirclesThere) {
  MissionSetup setup = setup_of("foam_trainer");
  setup.mission.home_world_m = {100.0, -50.0, 0.0};
  setup.mission.items = {waypoint(0, 600, 300), item_of(MissionCommand::kReturn)};
  setup.duration_max_s = 400.0;
  const MissionFlight flight = fly(setup, [](const MissionFlight&) { return true; });
  const FlightState state = flight_state(flight.aircraft());
  EXPECT_EQ(flight.autopilot().pilot().phase(), FlightPhase::kReturn);
  EXPECT_NEAR((state.position_world_m.head<2>() - Eigen::Vector2d(100, -50)).norm(),
              setup.parameters.wp_loiter_rad,
              3.0);
  EXPECT_NEAR(state.position_world_m.z(), setup.parameters.rtl_altitude, 2.0);
}

class LongHills final : public HeightQuery {
 public:
  [[nodiscard]] double ground_up_m(double /*east_m*/, double north_m) const override {
    return 30.0 * std::sin(north_m / 1200.0 * 2.0 * kPi);
  }
};

TEST(MissionFlight, FollowsTheTerrainWhereAsked) {
  MissionSetup setup = setup_of("piper_cub_third");
  setup.start_world_m = Eigen::Vector3d(0, 0, 150.0);
  MissionItem end = waypoint(0, 4800, 150);
  end.above_ground = true;
  setup.mission.items = {end};
  const auto hills = std::make_shared<LongHills>();
  double square = 0.0;
  int count = 0;
  double worst = 0.0;
  fly(
      setup,
      [&](const MissionFlight& at) {
        const Eigen::Vector3d& p = at.aircraft().state().position_world_m;
        const double off = p.z() - hills->ground_up_m(p.x(), p.y()) - 150.0;
        square += off * off;
        ++count;
        worst = larger_error(worst, std::abs(off));
        return true;
      },
      hills);
  print_figure("terrain following: height RMS [m]", std::sqrt(square / count));
  print_figure("terrain following: largest error [m]", worst);
  EXPECT_LT(std::sqrt(square / count), 3.0);
  EXPECT_LT(worst, 7.0);
}

TEST(MissionFlight, EndsWhereItHitsTheGround) {
  MissionSetup setup = setup_of("piper_cub_third");
  setup.start_world_m = Eigen::Vector3d(0, 0, 20.0);
  setup.mission.items = {waypoint(0, 2000, 20)};
  const auto hills = std::make_shared<LongHills>();
  const MissionFlight flight = fly(
      setup, [](const MissionFlight&) { return true; }, hills);
  EXPECT_EQ(flight.end(), FlightEnd::kHitGround);
  const auto truth = fly_mission(setup, hills).value();
  ASSERT_EQ(truth->warnings().size(), 1u);
  EXPECT_THAT(truth->warnings().front(), HasSubstr("hit the ground"));
  EXPECT_EQ(truth->duration_ns(), flight.t_ns());
}

TEST(MissionFlight, IsASourceOfTruthThatRepeats) {
  MissionSetup setup = setup_of("foam_trainer");
  setup.turbulence = dynamics::TurbulenceLevel::kSevere;
  setup.mission.items = {waypoint(0, 300, 300), waypoint(200, 300, 310)};
  const auto ground = std::make_shared<FlatGround>(0.0);
  const auto one = fly_mission(setup, ground).value();
  const auto two = fly_mission(setup, ground).value();
  ASSERT_TRUE(one->duration_ns().has_value());
  EXPECT_EQ(one->duration_ns(), two->duration_ns());
  EXPECT_THAT(one->description(), HasSubstr("severe turbulence"));
  std::optional<AircraftState> last;
  for (std::int64_t t = 0; t <= *one->duration_ns(); t += 7'300'000) {
    const auto a = one->state_at(t).value();
    const auto b = two->state_at(t).value();
    ASSERT_TRUE(a && b);
    ASSERT_EQ(a->t_ns, t);
    ASSERT_EQ(a->T_world_body.translation, b->T_world_body.translation);
    if (last) {
      // Positions and velocities belong together.
      const Eigen::Vector3d mean = 0.5 * (a->v_body_world_m_s + last->v_body_world_m_s);
      const Eigen::Vector3d moved = a->T_world_body.translation - last->T_world_body.translation;
      ASSERT_LT((moved - mean * 7.3e-3).norm(), 2e-3);
    }
    last = a;
  }
  EXPECT_FALSE(one->state_at(*one->duration_ns() + 1).value().has_value());
  setup.seed = 8;
  const auto other = fly_mission(setup, ground).value();
  const auto again = fly_mission(setup, ground).value();
  setup.seed = 7;
  const auto first = fly_mission(setup, ground).value();
  const auto position = [](TruthSource& truth) {
    return truth.state_at(5'000'000'000).value()->T_world_body.translation;
  };
  const Eigen::Vector3d with_8 = position(*other);
  EXPECT_EQ(with_8, position(*again));
  EXPECT_NE(with_8, position(*first));
}

TEST(MissionFlight, TellsItsPhasesAndItems) {
  MissionSetup setup = setup_of("foam_trainer");
  setup.mission.items = {waypoint(0, 400, 300), waypoint(400, 400, 300), waypoint(400, 0, 300)};
  // Items of a file that are not flown leave holes in the numbers.
  for (std::size_t i = 0; i < 3; ++i) {
    setup.mission.items[i].number = static_cast<std::uint16_t>(2 * i + 1);
  }
  for (const bool reported : {true, false}) {
    setup.report_items = reported;
    const auto flight = fly_mission(setup, std::make_shared<FlatGround>(0.0));
    ASSERT_TRUE(flight) << flight.error().message;
    std::vector<std::string> lines;
    std::int64_t last_ns = 0;
    for (std::int64_t t_ns = 0; t_ns <= *(*flight)->duration_ns(); t_ns += kNsPerS) {
      ASSERT_TRUE((*flight)->state_at(t_ns));
      for (const FlightEvent& event : (*flight)->take_events(t_ns)) {
        EXPECT_GE(event.t_ns, last_ns);
        EXPECT_LE(event.t_ns, t_ns);
        last_ns = event.t_ns;
        lines.push_back(std::string(to_string(event.kind)) + " " + event.text);
      }
    }
    if (reported) {
      EXPECT_THAT(lines,
                  ::testing::ElementsAre(std::string("mode ") + name_of(FlightPhase::kEnRoute),
                                         "mission mission item 1",
                                         "mission mission item 3",
                                         "mission mission item 5"));
    } else {
      EXPECT_TRUE(lines.empty());
    }
  }
}

TEST(MissionFlight, RejectsWhatItCannotFly) {
  const auto ground = std::make_shared<FlatGround>(0.0);
  const auto message = [&](const MissionSetup& setup) {
    const auto flight = fly_mission(setup, ground);
    return flight ? std::string("accepted") : flight.error().message;
  };
  MissionSetup setup = setup_of("foam_trainer");
  EXPECT_THAT(message(setup), HasSubstr("0 items"));
  setup.mission.items = {waypoint(0, std::numeric_limits<double>::quiet_NaN(), 300)};
  EXPECT_THAT(message(setup), HasSubstr("mission item 1: north_m"));
  setup.mission.items = {waypoint(0, 100, 300), item_of(MissionCommand::kTakeOff)};
  EXPECT_THAT(message(setup), HasSubstr("mission item 2: a take-off must be the first"));
  setup.mission.items = {item_of(MissionCommand::kLand), waypoint(0, 100, 300)};
  EXPECT_THAT(message(setup), HasSubstr("mission item 1: a landing must be the last"));
  setup.mission.items = {waypoint(0, 100, 300)};
  setup.parameters.airspeed_cruise = 7.0;
  EXPECT_THAT(message(setup), HasSubstr("AIRSPEED_CRUISE = 7"));
  setup = setup_of("foam_trainer");
  setup.mission.items = {waypoint(0, 100, 300)};
  setup.duration_max_s = 1e9;
  EXPECT_THAT(message(setup), HasSubstr("duration_max_s"));
  setup.duration_max_s = 10.0;
  setup.wind_world_m_s = {8.0, 7.0, 0.0};
  EXPECT_THAT(message(setup), HasSubstr("wind.speed_m_s = 10.6"));
  EXPECT_THAT(fly_mission(setup, nullptr).error().message, HasSubstr("ground"));
}

TEST(MissionFlight, CanBeCancelled) {
  MissionSetup setup = setup_of("foam_trainer");
  setup.mission.items = {item_of(MissionCommand::kLoiter, waypoint(0, 0, 300))};
  const std::atomic<bool> cancel = true;
  EXPECT_EQ(fly_mission(setup, std::make_shared<FlatGround>(0.0), &cancel).error().code,
            ErrorCode::kCancelled);
}

}  // namespace
}  // namespace overfly::autopilot
