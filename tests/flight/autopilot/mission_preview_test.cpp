// Previews of missions against their simulated flights and against closed forms.
#include "flight/autopilot/mission_preview.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/flight/autopilot/flights.hpp"

namespace overfly::autopilot {
namespace {

using ::testing::HasSubstr;
using testing::item_of;
using testing::print_figure;
using testing::setup_of;
using testing::waypoint;

constexpr const char* kPreviewed[] = {"foam_trainer", "piper_cub_third"};

std::shared_ptr<const HeightQuery> preview_ground() { return std::make_shared<FlatGround>(0.0); }

/// Largest distance of the simulated flight from the preview's path [m].
double farthest_from(const MissionPreview& preview, const std::vector<Eigen::Vector3d>& flown) {
  double farthest = 0.0;
  for (const Eigen::Vector3d& at : flown) {
    double least = 1e9;
    for (const PreviewState& state : preview.states) {
      least = std::min(least, (state.position_world_m - at).norm());
    }
    farthest = std::max(farthest, least);
  }
  return farthest;
}

TEST(MissionPreview, FliesWhereTheSimulatedAircraftFlies) {
  for (const char* name : kPreviewed) {
    MissionSetup setup = setup_of(name);
    setup.wind_world_m_s = {0.2 * setup.parameters.airspeed_cruise, 0.0, 0.0};
    MissionItem circle = item_of(MissionCommand::kLoiter, waypoint(2200, 0, 320));
    circle.radius_m = 120.0;
    circle.turns = 1.5;
    setup.mission.items = {
        waypoint(0, 1200, 300), waypoint(1200, 1200, 340), circle, waypoint(200, 0, 300)};
    std::vector<Eigen::Vector3d> flown;
    double largest_roll = 0.0;
    int step = 0;
    const MissionFlight flight = testing::fly(setup, [&](const MissionFlight& at) {
      const FlightState state = flight_state(at.aircraft());
      if (++step % 100 == 0) flown.push_back(state.position_world_m);
      largest_roll = std::max(largest_roll, std::abs(state.attitude.roll_rad));
      return true;
    });
    const MissionPreview preview = preview_mission(setup, preview_ground()).value();
    EXPECT_EQ(preview.end, FlightEnd::kMissionDone) << name;
    const double off_m = farthest_from(preview, flown);
    const double share = preview.states.back().t_s / testing::t_s(flight);
    double roll = 0.0;
    for (const PreviewState& state : preview.states) {
      roll = std::max(roll, std::abs(state.attitude.roll_rad));
    }
    print_figure(std::string(name) + ", preview: farthest from the flight [m]", off_m);
    print_figure(std::string(name) + ", preview: duration over the flight's", share);
    print_figure(std::string(name) + ", preview: largest bank less the flight's [deg]",
                 deg_from_rad(roll - largest_roll));
    EXPECT_LT(off_m, 15.0) << name;
    EXPECT_NEAR(share, 1.0, 0.02) << name;
    EXPECT_NEAR(deg_from_rad(roll), deg_from_rad(largest_roll), 6.0) << name;
  }
}

TEST(MissionPreview, BanksInCirclesByTheFormulaOfCoordinatedTurns) {
  MissionSetup setup = setup_of("piper_cub_third");
  MissionItem circle = item_of(MissionCommand::kLoiter, waypoint(0, 600, 300));
  circle.radius_m = 150.0;
  circle.turns = 3.0;
  setup.mission.items = {circle};
  const MissionPreview preview = preview_mission(setup, preview_ground()).value();
  // At the very end the wings are levelled.
  const PreviewState& last = preview.states[preview.states.size() - 50];
  const double speed = setup.parameters.airspeed_cruise;
  const double bank = std::atan(speed * speed / (setup.environment.gravity_m_s2 * 150.0));
  EXPECT_NEAR(last.attitude.roll_rad, bank, rad_from_deg(0.5));
  EXPECT_NEAR((last.position_world_m.head<2>() - Eigen::Vector2d(0, 600)).norm(), 150.0, 1.0);
  EXPECT_NEAR(last.ground_speed_m_s, speed, 0.05);
}

TEST(MissionPreview, TakesOffAndLands) {
  for (const char* name : kPreviewed) {
    MissionSetup setup = setup_of(name);
    setup.start_world_m.reset();
    setup.mission.items = {item_of(MissionCommand::kTakeOff, waypoint(0, 300, 60)),
                           waypoint(0, 1200, 80),
                           waypoint(500, 1200, 80),
                           waypoint(500, 600, 45),
                           item_of(MissionCommand::kLand, waypoint(500, 0, 0))};
    const MissionFlight flight = testing::fly(setup, [](const MissionFlight&) { return true; });
    const MissionPreview preview = preview_mission(setup, preview_ground()).value();
    EXPECT_EQ(flight.end(), FlightEnd::kLanded) << name;
    EXPECT_EQ(preview.end, FlightEnd::kLanded) << name;
    EXPECT_NEAR(preview.states.back().t_s / testing::t_s(flight), 1.0, 0.06) << name;
    const Eigen::Vector3d down = flight_state(flight.aircraft()).position_world_m;
    // The flight model floats in the flare: the Cub for 72 m.
    EXPECT_LT((preview.states.back().position_world_m - down).norm(), 100.0) << name;
  }
}

TEST(MissionPreview, SeesAHillInItsWay) {
  class Hill final : public HeightQuery {
   public:
    [[nodiscard]] double ground_up_m(double /*east_m*/, double north_m) const override {
      return north_m > 700.0 ? 400.0 : 0.0;
    }
  };
  MissionSetup setup = setup_of("piper_cub_third");
  setup.mission.items = {waypoint(0, 1500, 300)};
  const MissionPreview preview = preview_mission(setup, std::make_shared<Hill>()).value();
  EXPECT_EQ(preview.end, FlightEnd::kHitGround);
  EXPECT_NEAR(preview.states.back().position_world_m.y(), 700.0, 5.0);
}

TEST(MissionPreview, ReportsWhatTheFlightWouldReport) {
  MissionSetup setup = setup_of("piper_cub_third");
  const auto message = [&] { return preview_mission(setup, preview_ground()).error().message; };
  EXPECT_THAT(message(), HasSubstr("a mission of 0 items"));
  setup.mission.items = {item_of(MissionCommand::kTakeOff, waypoint(0, 0, 50))};
  EXPECT_THAT(message(), HasSubstr("a take-off is flown from the ground"));
  setup.mission.items = {item_of(MissionCommand::kLoiter, waypoint(0, 600, 300))};
  const std::atomic<bool> cancel{true};
  const auto cancelled = preview_mission(setup, preview_ground(), &cancel);
  EXPECT_EQ(cancelled.error().code, ErrorCode::kCancelled);
  setup.duration_max_s = 60.0;
  EXPECT_EQ(preview_mission(setup, preview_ground())->end, FlightEnd::kTimeLimit);
}

}  // namespace
}  // namespace overfly::autopilot
