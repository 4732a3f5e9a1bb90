// Missions of ground stations: heights, frames, commands, and a recorded one flown.
#include "flight/autopilot/mission_items.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/flight/autopilot/flights.hpp"

namespace overfly::autopilot {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;
using PlanItem = flight::mavlink::MissionItem;

constexpr double kLatDeg = 35.0;
constexpr double kLonDeg = -120.0;

LocalFrame plan_frame() { return LocalFrame(geodetic_from_deg(kLatDeg, kLonDeg, 200.0)); }

PlanItem plan_item(std::uint16_t command, double lat_deg, double lon_deg, float z) {
  PlanItem item;
  item.command = command;
  item.x = lat_deg;
  item.y = lon_deg;
  item.z = z;
  return item;
}

PlanItem plan_home() {
  PlanItem home = plan_item(16, kLatDeg, kLonDeg, 230.0F);
  home.frame = 0;
  return home;
}

Result<PlannedMission> plan(std::vector<PlanItem> items,
                            const std::optional<Eigen::Vector2d>& home_m = {}) {
  items.insert(items.begin(), plan_home());
  return plan_mission(items, plan_frame(), FlatGround(-5.0), home_m);
}

TEST(MissionItems, KeepHeightsOverHomeSeaLevelAndTerrain) {
  std::vector<PlanItem> items(3, plan_item(16, kLatDeg + 0.01, kLonDeg, 300.0F));
  items[1].frame = 0;
  items[1].z = 330.0F;
  items[2].frame = 10;
  items[2].z = 120.0F;
  const PlannedMission planned = plan(items).value();
  ASSERT_THAT(planned.mission.items, SizeIs(3));
  EXPECT_DOUBLE_EQ(planned.mission.home_world_m.z(), -5.0);
  EXPECT_DOUBLE_EQ(planned.mission.items[0].height_m, 295.0);
  EXPECT_DOUBLE_EQ(planned.mission.items[1].height_m, 95.0);  // 330 - 230 above home
  EXPECT_DOUBLE_EQ(planned.mission.items[2].height_m, 120.0);
  EXPECT_TRUE(planned.mission.items[2].above_ground);
  // 0.01 deg of latitude at 35 deg: 1109.4 m on WGS84, +31 ppm at 200 m.
  EXPECT_NEAR(planned.mission.items[0].position_m.y(), 1109.5, 0.3);
  EXPECT_NEAR(planned.heading_rad, 0.0, 1e-6);
}

TEST(MissionItems, CanBeMovedToAnotherHome) {
  const std::vector<PlanItem> items{plan_item(16, kLatDeg, kLonDeg + 0.01, 100.0F)};
  const PlannedMission there = plan(items).value();
  const PlannedMission here = plan(items, Eigen::Vector2d(500.0, -300.0)).value();
  EXPECT_TRUE(here.mission.home_world_m.head<2>().isApprox(Eigen::Vector2d(500.0, -300.0)));
  const Eigen::Vector2d moved =
      here.mission.items[0].position_m - there.mission.items[0].position_m;
  EXPECT_NEAR((moved - Eigen::Vector2d(500.0, -300.0)).norm(), 0.0, 1e-6);
}

TEST(MissionItems, ReadTheParametersOfCommands) {
  PlanItem turns = plan_item(18, kLatDeg + 0.01, kLonDeg, 100.0F);
  turns.parameters = {2.0F, 0.0F, -80.0F, 0.0F};
  PlanItem timed = plan_item(19, kLatDeg + 0.01, kLonDeg, 100.0F);
  timed.parameters = {30.0F, 0.0F, std::numeric_limits<float>::quiet_NaN(), 0.0F};
  PlanItem speed = plan_item(178, 0.0, 0.0, 0.0F);
  speed.parameters = {0.0F, 22.0F, -1.0F, 0.0F};
  PlanItem camera = plan_item(203, 0.0, 0.0, 0.0F);
  const PlannedMission planned =
      plan({plan_item(22, 0.0, 0.0, 60.0F), turns, speed, camera, timed, plan_item(20, 0, 0, 0)})
          .value();
  const auto& items = planned.mission.items;
  ASSERT_THAT(items, SizeIs(5));
  EXPECT_EQ(items[0].command, MissionCommand::kTakeOff);
  EXPECT_EQ(items[1].turns, 2.0);
  EXPECT_EQ(items[1].radius_m, -80.0);
  EXPECT_EQ(items[2].command, MissionCommand::kSetSpeed);
  EXPECT_EQ(items[2].airspeed_m_s, 22.0);
  EXPECT_EQ(items[3].time_s, 30.0);
  EXPECT_EQ(items[3].radius_m, 0.0);
  EXPECT_EQ(items[4].command, MissionCommand::kReturn);
  EXPECT_EQ(items[4].turns, 1.0);
  ASSERT_THAT(planned.warnings, SizeIs(1));
  EXPECT_THAT(planned.warnings[0], HasSubstr("item 4: command 203 was left out"));
}

TEST(MissionItems, ReadCirclesUpToAHeight) {
  PlanItem circle = plan_item(31, kLatDeg + 0.01, kLonDeg, 200.0F);
  circle.parameters = {1.0F, -90.0F, 0.0F, 1.0F};
  const PlannedMission planned = plan({circle}).value();
  ASSERT_THAT(planned.mission.items, SizeIs(1));
  EXPECT_EQ(planned.mission.items[0].command, MissionCommand::kLoiter);
  EXPECT_TRUE(planned.mission.items[0].until_height);
  EXPECT_EQ(planned.mission.items[0].radius_m, -90.0);
  // It has an end of its own.
  EXPECT_FALSE(planned.mission.items[0].turns.has_value());
}

TEST(MissionItems, WithoutAPlaceTakeTheLastOne) {
  PlanItem speed = plan_item(178, 0.0, 0.0, 0.0F);
  speed.parameters = {0.0F, 22.0F, -1.0F, 0.0F};
  const PlannedMission lands =
      plan({plan_item(16, kLatDeg + 0.01, kLonDeg, 100.0F), speed, plan_item(21, 0.0, 0.0, 0.0F)})
          .value();
  EXPECT_EQ(lands.mission.items[2].position_m, lands.mission.items[0].position_m);
  // Home is not the world's origin.
  const Eigen::Vector2d home(500.0, -300.0);
  const PlannedMission returns = plan({plan_item(20, 0.0, 0.0, 0.0F),
                                       plan_item(17, 0.0, 0.0, 100.0F),
                                       plan_item(16, kLatDeg, kLonDeg + 0.01, 100.0F)},
                                      home)
                                     .value();
  EXPECT_EQ(returns.mission.items[1].position_m, home);
  EXPECT_NEAR(returns.heading_rad, 0.5 * kPi, 1e-3);
  const auto none = plan({speed, plan_item(16, 0.0, 0.0, 100.0F)});
  ASSERT_FALSE(none.ok());
  EXPECT_THAT(none.error().message, HasSubstr("item 2: has no position"));
}

TEST(MissionItems, RejectWhatCannotBeFlown) {
  const auto message = [](const std::vector<PlanItem>& items) {
    const auto planned = plan(items);
    return planned ? std::string("accepted") : planned.error().message;
  };
  EXPECT_THAT(message({}), HasSubstr("1 items"));
  EXPECT_THAT(message({plan_item(82, kLatDeg, kLonDeg, 1.0F)}), HasSubstr("item 1: command 82"));
  EXPECT_THAT(message({plan_item(16, 95.0, kLonDeg, 1.0F)}), HasSubstr("out of range"));
  EXPECT_THAT(message({plan_item(16, std::nan(""), kLonDeg, 1.0F)}), HasSubstr("out of range"));
  PlanItem local = plan_item(16, 10.0, 10.0, 1.0F);
  local.frame = 1;
  EXPECT_THAT(message({local}), HasSubstr("frame 1"));
  EXPECT_THAT(message({plan_item(16, 0.0, 0.0, 100.0F)}), HasSubstr("no position"));
  // By the item's number in the file, also behind one that is left out.
  EXPECT_THAT(
      message({plan_item(203, 0.0, 0.0, 0.0F), plan_item(16, kLatDeg, kLonDeg + 40.0, 100.0F)}),
      HasSubstr("mission item 2: east_m"));
}

TEST(MissionItems, FlyTheMissionThatArduPlaneFlew) {
  const auto file = overfly::testing::shared_data("sitl/plane25_mission.waypoints");
  if (!file) GTEST_SKIP() << "no shared data";
  const auto items = flight::mavlink::read_mission_file(*file).value().items;
  const LocalFrame frame(geodetic_from_deg(items.front().x, items.front().y, 584.0));
  const auto ground = std::make_shared<FlatGround>(0.0);
  PlannedMission planned = plan_mission(items, frame, *ground, {}).value();
  MissionSetup setup = testing::setup_of("piper_cub_third");
  setup.start_world_m.reset();
  setup.heading_rad = planned.heading_rad;
  setup.mission = planned.mission;
  double highest = 0.0;
  double reached_s = 0.0;
  double fastest = 0.0;
  const MissionFlight flight = testing::fly(setup, [&](const MissionFlight& at) {
    const FlightState state = flight_state(at.aircraft());
    highest = std::max(highest, state.position_world_m.z());
    fastest = std::max(fastest, state.airspeed_m_s);
    if (at.autopilot().pilot().phase() == FlightPhase::kReturn && reached_s == 0.0) {
      reached_s = testing::t_s(at);
    }
    return true;
  });
  // It ends with a return: one circle at home.
  EXPECT_EQ(flight.end(), FlightEnd::kMissionDone);
  EXPECT_GT(reached_s, 300.0);
  EXPECT_LT(reached_s, 520.0);
  EXPECT_NEAR(highest, 300.0, 5.0);
  EXPECT_LT(fastest, 30.0);
}

}  // namespace
}  // namespace overfly::autopilot
