// The simulated vehicle against the operations of a ground station, in the vehicle's own time.
#include "flight/vehicle/simulated_vehicle.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <optional>

#include "flight/mavlink/vehicle/commands.hpp"
#include "flight/mavlink/vehicle/message_rates.hpp"
#include "flight/mavlink/vehicle/mission.hpp"
#include "flight/mavlink/vehicle/parameters.hpp"
#include "tests/flight/vehicle/direct_exchange.hpp"

namespace overfly::vehicle {
namespace {

using flight::mavlink::HeldMessage;
using flight::mavlink::MessageId;
using flight::mavlink::PayloadWriter;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<flight::mavlink::MissionItem> pattern() {
  return flight::mavlink::read_mission_file(
             overfly::testing::source_file("scenarios/missions/airfield_pattern.waypoints"))
      .value()
      .items;
}

TEST(SimulatedVehicle, TellsAndTakesItsParameters) {
  DirectExchange exchange;
  const auto all = flight::mavlink::read_all_parameters(exchange);
  ASSERT_TRUE(all.ok()) << all.error().message;
  EXPECT_EQ(all->size(), autopilot::parameter_table().size());
  ASSERT_TRUE(flight::mavlink::set_parameter(exchange, "RLL2SRV_RMAX", 55.0).ok());
  EXPECT_EQ(flight::mavlink::read_parameter(exchange, "RLL2SRV_RMAX")->value, 55.0);
  // Out of its limits: the vehicle keeps the old value, which the operation notices.
  EXPECT_FALSE(flight::mavlink::set_parameter(exchange, "RLL2SRV_RMAX", 5000.0).ok());
  EXPECT_EQ(flight::mavlink::read_parameter(exchange, "RLL2SRV_RMAX")->value, 55.0);
  EXPECT_FALSE(flight::mavlink::set_parameter(exchange, "WP_LOITER_RAD", 0.0).ok());
  EXPECT_GT(flight::mavlink::read_parameter(exchange, "WP_LOITER_RAD")->value, 30.0);
  EXPECT_FALSE(flight::mavlink::read_parameter(exchange, "NO_SUCH").ok());
}

TEST(SimulatedVehicle, KeepsAMissionAndRefusesOneThatItCannotFly) {
  DirectExchange exchange;
  const auto items = pattern();
  ASSERT_TRUE(flight::mavlink::upload_mission(exchange, items).ok());
  const auto held = flight::mavlink::download_mission(exchange);
  ASSERT_TRUE(held.ok()) << held.error().message;
  ASSERT_EQ(held->size(), items.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    EXPECT_EQ((*held)[i].command, items[i].command);
    EXPECT_NEAR((*held)[i].x, items[i].x, 1e-7);
    EXPECT_NEAR((*held)[i].y, items[i].y, 1e-7);
    EXPECT_EQ((*held)[i].z, items[i].z);
  }
  auto odd = items;
  odd[2].command = 94;  // a command for other vehicles
  const Status refused = flight::mavlink::upload_mission(exchange, odd);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("error"));
  // The vehicle says why.
  exchange.pass(MessageId::kMissionCount,
                PayloadWriter(9).put(0, std::uint16_t{2}).put(2, std::uint8_t{1}).bytes());
  for (std::size_t i = 0; i < 2; ++i) {
    exchange.pass(MessageId::kMissionItemInt,
                  flight::mavlink::encode_mission_item(odd[i + 1], i, 1, 1).bytes());
  }
  exchange.collect();
  EXPECT_THAT(exchange.texts, Contains(HasSubstr("mission item 1: command 94")));
  EXPECT_EQ(flight::mavlink::download_mission(exchange)->size(), items.size());
  // Fences and rally points: none, and none are taken.
  exchange.inbox.clear();
  exchange.pass(MessageId::kMissionRequestList,
                PayloadWriter(3).put(0, std::uint8_t{1}).put(2, std::uint8_t{1}).bytes());
  ASSERT_EQ(exchange.inbox.size(), 1u);
  EXPECT_EQ(exchange.inbox.front().reader().at<std::uint16_t>(0), 0);
  EXPECT_EQ(exchange.inbox.front().reader().at<std::uint8_t>(4), 1);
}

TEST(SimulatedVehicle, AsksAgainForItemsThatGetLostAndGivesUp) {
  DirectExchange exchange;
  exchange.pass(MessageId::kMissionCount,
                PayloadWriter(9).put(0, std::uint16_t{3}).put(2, std::uint8_t{1}).bytes());
  exchange.fly(20.0,
               [&](const VehicleReport&) { return exchange.counts[MessageId::kMissionAck] > 0; });
  EXPECT_EQ(exchange.counts[MessageId::kMissionRequestInt], 6);
  EXPECT_EQ(exchange.counts[MessageId::kMissionAck], 1);
}

TEST(SimulatedVehicle, FliesAnUploadedMissionToItsLanding) {
  DirectExchange exchange;
  ASSERT_TRUE(flight::mavlink::upload_mission(exchange, pattern()).ok());
  const Status early = flight::mavlink::start_mission(exchange);
  EXPECT_FALSE(early.ok());  // not armed
  ASSERT_TRUE(flight::mavlink::arm(exchange, std::chrono::seconds(5)).ok());
  ASSERT_TRUE(flight::mavlink::start_mission(exchange).ok());
  EXPECT_FALSE(flight::mavlink::disarm(exchange).ok());  // in flight
  double highest = 0.0;
  exchange.fly(900.0, [&](const VehicleReport& at) {
    highest = std::max(highest, at.state.position_world_m.z());
    return !at.armed;
  });
  EXPECT_NEAR(highest, 150.0, 5.0);
  EXPECT_THAT(exchange.texts, Contains("Landed"));
  EXPECT_THAT(exchange.reached, ElementsAre(1, 2, 3, 4, 5, 6, 7));
  const VehicleReport end = exchange.vehicle->report();
  EXPECT_FALSE(end.in_air);
  EXPECT_EQ(end.mode, Mode::kManual);
  EXPECT_LT(end.state.position_world_m.head<2>().norm(), 200.0);
  // It flies again from where it stands.
  ASSERT_TRUE(flight::mavlink::arm(exchange, std::chrono::seconds(5)).ok());
  ASSERT_TRUE(flight::mavlink::start_mission(exchange).ok());
  exchange.fly(30.0, [](const VehicleReport&) { return false; });
  EXPECT_GT(exchange.vehicle->report().state.position_world_m.z(), 30.0);
}

TEST(SimulatedVehicle, ChangesModesInFlightAndResumesItsMission) {
  DirectExchange exchange;
  ASSERT_TRUE(flight::mavlink::upload_mission(exchange, pattern()).ok());
  ASSERT_TRUE(flight::mavlink::arm(exchange, std::chrono::seconds(5)).ok());
  ASSERT_TRUE(flight::mavlink::start_mission(exchange).ok());
  exchange.fly(200.0, [](const VehicleReport& at) { return at.mission_item == 3; });
  ASSERT_EQ(exchange.vehicle->report().mission_item, 3);
  // A repeated command changes nothing.
  ASSERT_TRUE(flight::mavlink::change_mode(exchange, 10).ok());  // AUTO
  ASSERT_TRUE(flight::mavlink::start_mission(exchange).ok());
  EXPECT_EQ(exchange.vehicle->report().mission_item, 3);
  ASSERT_TRUE(flight::mavlink::change_mode(exchange, 12).ok());  // LOITER
  const Eigen::Vector3d there = exchange.vehicle->report().state.position_world_m;
  exchange.fly(60.0, [](const VehicleReport&) { return false; });
  EXPECT_LT((exchange.vehicle->report().state.position_world_m - there).head<2>().norm(), 250.0);
  ASSERT_TRUE(flight::mavlink::change_mode(exchange, 11).ok());  // RTL
  exchange.fly(200.0, [](const VehicleReport&) { return false; });
  EXPECT_NEAR(exchange.vehicle->report().state.position_world_m.z(), 100.0, 3.0);
  EXPECT_LT(exchange.vehicle->report().state.position_world_m.head<2>().norm(), 150.0);
  ASSERT_TRUE(flight::mavlink::change_mode(exchange, 10).ok());  // AUTO
  EXPECT_EQ(exchange.vehicle->report().mission_item, 3);
  EXPECT_FALSE(flight::mavlink::change_mode(exchange, 5).ok());  // FBWA: no pilot
  // GUIDED: a circle around a place.
  const Geodetic home = cub_at_home().home;
  PayloadWriter command(35);
  command.put(16, static_cast<std::int32_t>(1e7 * (deg_from_rad(home.lat_rad) + 0.005)))
      .put(20, static_cast<std::int32_t>(1e7 * deg_from_rad(home.lon_rad)))
      .put(24, 130.0F)
      .put(28, std::uint16_t{192})
      .put(30, std::uint8_t{1})
      .put(32, std::uint8_t{3});
  exchange.inbox.clear();
  exchange.pass(MessageId::kCommandInt, command.bytes());
  ASSERT_EQ(exchange.inbox.back().reader().at<std::uint8_t>(2), 0);
  exchange.fly(200.0, [](const VehicleReport&) { return false; });
  const VehicleReport guided = exchange.vehicle->report();
  EXPECT_EQ(guided.mode, Mode::kGuided);
  EXPECT_NEAR(guided.state.position_world_m.z(), 130.0, 3.0);
  EXPECT_NEAR((guided.state.position_world_m.head<2>() - Eigen::Vector2d(0.0, 555.0)).norm(),
              81.6,  // WP_LOITER_RAD of 20 m/s
              5.0);
}

TEST(SimulatedVehicle, SendsAtTheRatesAskedFor) {
  DirectExchange exchange;
  const auto set = [&](MessageId id, float interval_us) {
    PayloadWriter command(33);
    command.put(0, static_cast<float>(id))
        .put(4, interval_us)
        .put(28, std::uint16_t{511})
        .put(30, std::uint8_t{1});
    exchange.pass(MessageId::kCommandLong, command.bytes());
  };
  set(MessageId::kAttitude, 20'000.0F);
  set(MessageId::kSimState, 25'000.0F);
  set(MessageId::kVfrHud, -1.0F);
  set(MessageId::kParamValue, 1000.0F);  // not a stream
  exchange.fly(10.0, [](const VehicleReport&) { return false; });
  EXPECT_NEAR(exchange.counts[MessageId::kAttitude], 500, 2);
  EXPECT_NEAR(exchange.counts[MessageId::kSimState], 400, 10);
  EXPECT_EQ(exchange.counts[MessageId::kVfrHud], 0);
  EXPECT_NEAR(exchange.counts[MessageId::kHeartbeat], 10, 1);
  EXPECT_EQ(exchange.counts[MessageId::kParamValue], 0);
}

TEST(SimulatedVehicle, ChangesTheRatesOfOneStreamOnly) {
  DirectExchange exchange;
  const auto ask = [&](std::uint8_t stream, std::uint16_t rate_hz, std::uint8_t on) {
    exchange.pass(
        MessageId::kRequestDataStream,
        PayloadWriter(6).put(0, rate_hz).put(2, std::uint8_t{1}).put(4, stream).put(5, on).bytes());
  };
  ask(6, 20, 1);
  ask(11, 4, 0);
  exchange.fly(10.0, [](const VehicleReport&) { return false; });
  EXPECT_NEAR(exchange.counts[MessageId::kGlobalPositionInt], 200, 2);
  EXPECT_NEAR(exchange.counts[MessageId::kAttitude], 100, 2);  // another stream: as before
  EXPECT_EQ(exchange.counts[MessageId::kVfrHud], 0);
  EXPECT_NEAR(exchange.counts[MessageId::kHeartbeat], 10, 1);
}

TEST(SimulatedVehicle, ReportsItsSensorsAndAnAbsentFenceAsHealthy) {
  DirectExchange exchange;
  std::optional<HeldMessage> status;
  while (!status) {
    const auto next = exchange.next(exchange.now() + std::chrono::seconds(5));
    ASSERT_TRUE(next && *next) << "no SYS_STATUS within 5 s";
    if ((*next)->is(MessageId::kSysStatus)) status = **next;
  }
  // MAV_SYS_STATUS_SENSOR: gyro, accelerometer, magnetometer, both pressures, GPS; AHRS; GEOFENCE.
  constexpr std::uint32_t kSensors = 1 | 2 | 4 | 8 | 16 | 32 | 0x200000;
  EXPECT_EQ(status->reader().at<std::uint32_t>(0), kSensors);
  EXPECT_EQ(status->reader().at<std::uint32_t>(4), kSensors);
  EXPECT_EQ(status->reader().at<std::uint32_t>(8), kSensors | 0x100000);
}

TEST(SimulatedVehicle, RefusesNumbersThatAreNone) {
  DirectExchange exchange;
  for (const float odd : {std::nanf(""), HUGE_VALF, -1.0F, 1e30F}) {
    for (const std::uint16_t id : {std::uint16_t{176}, std::uint16_t{511}, std::uint16_t{512}}) {
      exchange.inbox.clear();
      PayloadWriter command(33);
      command.put(0, odd).put(4, odd).put(28, id).put(30, std::uint8_t{1});
      exchange.pass(MessageId::kCommandLong, command.bytes());
      ASSERT_FALSE(exchange.inbox.empty());
      const HeldMessage& answer = exchange.inbox.back();
      ASSERT_TRUE(answer.is(MessageId::kCommandAck) || answer.is(MessageId::kHeartbeat));
      // Message 0 and mode 0 exist: what is no number counts as 0 there.
      if (id == 511) {
        EXPECT_NE(answer.reader().at<std::uint8_t>(2), 0);
      }
    }
  }
  // The longest interval is bounded, not undefined.
  PayloadWriter command(33);
  command.put(0, 30.0F).put(4, 1e30F).put(28, std::uint16_t{511}).put(30, std::uint8_t{1});
  exchange.pass(MessageId::kCommandLong, command.bytes());
  exchange.inbox.clear();
  exchange.fly(5.0, [](const VehicleReport&) { return false; });
  EXPECT_LE(exchange.counts[MessageId::kAttitude], 1);
}

TEST(SimulatedVehicle, CrashesWhereItIsDisarmedByForce) {
  DirectExchange exchange;
  ASSERT_TRUE(flight::mavlink::upload_mission(exchange, pattern()).ok());
  ASSERT_TRUE(flight::mavlink::arm(exchange, std::chrono::seconds(5)).ok());
  ASSERT_TRUE(flight::mavlink::start_mission(exchange).ok());
  exchange.fly(40.0, [](const VehicleReport&) { return false; });
  const Eigen::Vector3d above = exchange.vehicle->report().state.position_world_m;
  ASSERT_GT(above.head<2>().norm(), 100.0);
  PayloadWriter command(33);
  command.put(0, 0.0F).put(4, 21196.0F).put(28, std::uint16_t{400}).put(30, std::uint8_t{1});
  exchange.pass(MessageId::kCommandLong, command.bytes());
  const VehicleReport end = exchange.vehicle->report();
  EXPECT_FALSE(end.armed || end.in_air);
  EXPECT_EQ(end.state.position_world_m, Eigen::Vector3d(above.x(), above.y(), 0.0));
}

TEST(SimulatedVehicle, ContinuesAShorterMissionAtItsLastItem) {
  DirectExchange exchange;
  ASSERT_TRUE(flight::mavlink::upload_mission(exchange, pattern()).ok());
  ASSERT_TRUE(flight::mavlink::arm(exchange, std::chrono::seconds(5)).ok());
  ASSERT_TRUE(flight::mavlink::start_mission(exchange).ok());
  exchange.fly(300.0, [](const VehicleReport& at) { return at.mission_item == 4; });
  ASSERT_TRUE(flight::mavlink::change_mode(exchange, 12).ok());
  auto shorter = pattern();
  shorter.resize(3);
  ASSERT_TRUE(flight::mavlink::upload_mission(exchange, shorter).ok());
  ASSERT_TRUE(flight::mavlink::change_mode(exchange, 10).ok());
  EXPECT_EQ(exchange.vehicle->report().mission_item, 2);
}

TEST(SimulatedVehicle, AnswersWhatTimeItIs) {
  DirectExchange exchange;
  exchange.fly(2.0, [](const VehicleReport&) { return false; });
  exchange.inbox.clear();
  exchange.pass(MessageId::kTimesync, PayloadWriter(18).put(8, std::int64_t{77}).bytes());
  ASSERT_EQ(exchange.inbox.size(), 1u);
  EXPECT_EQ(exchange.inbox.front().reader().at<std::int64_t>(0), 2'000'000'000);
  EXPECT_EQ(exchange.inbox.front().reader().at<std::int64_t>(8), 77);
}

TEST(SimulatedVehicle, IgnoresMessagesToOthersAndNonsense) {
  DirectExchange exchange;
  PayloadWriter other(33);
  other.put(0, 1.0F).put(28, std::uint16_t{400}).put(30, std::uint8_t{9});
  exchange.pass(MessageId::kCommandLong, other.bytes());
  EXPECT_TRUE(exchange.inbox.empty());
  // Random payloads to every message that it knows.
  std::uint32_t state = 1;
  for (int i = 0; i < 20000; ++i) {
    std::vector<std::uint8_t> payload(static_cast<std::size_t>(i % 60));
    for (auto& byte : payload) {
      state = state * 1664525U + 1013904223U;
      byte = static_cast<std::uint8_t>(state >> 24U);
    }
    exchange.pass(static_cast<MessageId>(i % 130), payload);
    if (i % 50 == 0) exchange.vehicle->step([](auto, const auto&, auto) {});
    exchange.inbox.clear();
  }
  EXPECT_TRUE(exchange.vehicle->report().state.position_world_m.allFinite());
}

}  // namespace
}  // namespace overfly::vehicle
