// What the simulated vehicle flies when missions, items and parameters change.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "flight/mavlink/vehicle/commands.hpp"
#include "flight/mavlink/vehicle/mission.hpp"
#include "flight/mavlink/vehicle/parameters.hpp"
#include "tests/flight/vehicle/direct_exchange.hpp"

namespace overfly::vehicle {
namespace {

using flight::mavlink::MessageId;
using flight::mavlink::MissionItem;
using flight::mavlink::PayloadWriter;

/// An item south of home, where the vehicle heads for.
MissionItem south_of_home(std::uint16_t command, double south_m, float z) {
  const Geodetic home = cub_at_home().home;
  MissionItem item;
  item.command = command;
  item.x = deg_from_rad(home.lat_rad) - south_m / 111'000.0;
  item.y = deg_from_rad(home.lon_rad);
  item.z = z;
  return item;
}

void start_flight(DirectExchange& exchange, std::vector<MissionItem> items) {
  MissionItem nowhere;  // item 0, as a ground station without a home uploads it
  nowhere.frame = 0;
  items.insert(items.begin(), nowhere);
  const Status uploaded = flight::mavlink::upload_mission(exchange, items);
  ASSERT_TRUE(uploaded.ok()) << uploaded.error().message;
  ASSERT_TRUE(flight::mavlink::arm(exchange, std::chrono::seconds(5)).ok());
  ASSERT_TRUE(flight::mavlink::start_mission(exchange).ok());
}

MissionItem airspeed_item(float airspeed_m_s) {
  MissionItem item;
  item.command = 178;
  item.parameters = {0.0F, airspeed_m_s, -1.0F, 0.0F};
  return item;
}

bool never(const VehicleReport& /*at*/) { return false; }

TEST(VehicleMission, CountsFromTheVehiclesHomeWhateverItem0Is) {
  DirectExchange exchange;
  MissionItem above_sea = south_of_home(16, 600.0, 347.7F);  // 120 m above home
  above_sea.frame = 0;
  start_flight(exchange, {south_of_home(22, 300.0, 60.0F), above_sea, south_of_home(20, 0.0, 0)});
  exchange.fly(200.0, [](const VehicleReport& at) { return at.mission_item == 3; });
  ASSERT_EQ(exchange.vehicle->report().mission_item, 3);
  EXPECT_NEAR(exchange.vehicle->report().state.position_world_m.z(), 120.0, 15.0);
  exchange.fly(80.0, never);
  EXPECT_NEAR(exchange.vehicle->report().state.position_world_m.z(), 100.0, 5.0);
  EXPECT_LT(exchange.vehicle->report().state.position_world_m.head<2>().norm(), 200.0);
}

TEST(VehicleMission, FliesBackToAnItemThatLiesBehind) {
  DirectExchange exchange;
  start_flight(exchange,
               {south_of_home(22, 100.0, 60.0F),
                south_of_home(16, 500.0, 100.0F),
                south_of_home(16, 900.0, 100.0F),
                south_of_home(16, 4000.0, 100.0F)});
  exchange.fly(200.0, [](const VehicleReport& at) { return at.mission_item == 4; });
  exchange.fly(10.0, never);
  const double beyond_m = -900.0 - exchange.vehicle->report().state.position_world_m.y();
  ASSERT_GT(beyond_m, 100.0);
  exchange.pass(MessageId::kMissionSetCurrent,
                PayloadWriter(4).put(0, std::uint16_t{3}).put(2, std::uint8_t{1}).bytes());
  exchange.reached.clear();
  exchange.fly(0.1, never);
  EXPECT_EQ(exchange.vehicle->report().mission_item, 3);
  exchange.fly(60.0, [](const VehicleReport& at) { return at.mission_item == 4; });
  EXPECT_THAT(exchange.reached, ::testing::ElementsAre(3));
  // The turn to the next item begins before it.
  EXPECT_NEAR(exchange.vehicle->report().state.position_world_m.y(), -900.0, 90.0);
}

TEST(VehicleMission, GoesOnWithItsCircleAndSpeedWhenParametersChange) {
  DirectExchange exchange;
  MissionItem circle = south_of_home(18, 400.0, 100.0F);
  circle.parameters = {2.0F, 0.0F, 100.0F, 0.0F};
  start_flight(exchange,
               {south_of_home(22, 100.0, 60.0F),
                airspeed_item(24.0F),
                circle,
                south_of_home(16, 4000.0, 100.0F)});
  exchange.fly(60.0, [](const VehicleReport& at) { return at.mission_item == 3; });
  ASSERT_EQ(exchange.vehicle->report().mission_item, 3);
  // Two turns of 26 s, and the way there.
  for (int i = 0; i < 20 && exchange.vehicle->report().mission_item == 3; ++i) {
    const double limit = i % 2 == 0 ? 60.0 : 65.0;
    ASSERT_TRUE(flight::mavlink::set_parameter(exchange, "RLL2SRV_RMAX", limit).ok());
    exchange.fly(5.0, never);
  }
  EXPECT_EQ(exchange.vehicle->report().mission_item, 4);
  EXPECT_NEAR(exchange.vehicle->report().state.airspeed_m_s, 24.0, 1.5);
  // The speed holds after an interruption as well.
  ASSERT_TRUE(flight::mavlink::change_mode(exchange, 12).ok());  // LOITER
  exchange.fly(20.0, never);
  ASSERT_TRUE(flight::mavlink::change_mode(exchange, 10).ok());  // AUTO
  exchange.fly(30.0, never);
  EXPECT_EQ(exchange.vehicle->report().mission_item, 4);
  EXPECT_NEAR(exchange.vehicle->report().state.airspeed_m_s, 24.0, 1.0);
}

}  // namespace
}  // namespace overfly::vehicle
