// The flight of a vehicle over the loopback interface, with its messages made by hand.
#include "flight/live/live_truth.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "flight/mavlink/payload.hpp"
#include "tests/flight/live/made_vehicle.hpp"

namespace overfly::flight::live {
namespace {

using mavlink::PayloadWriter;
using std::chrono::milliseconds;
using ::testing::ElementsAre;
using testing::frame_bytes;
using ::testing::HasSubstr;

TEST(LiveTruth, FliesTheEstimateByTheVehiclesClock) {
  OpenedTruth live;
  ASSERT_NE(live.truth, nullptr);
  EXPECT_THAT(live.truth->description(),
              HasSubstr("the estimate (1.1/GLOBAL_POSITION_INT, 1.1/ATTITUDE)"));
  live.fly_until(70000);
  const std::uint32_t asked_ms = live.last_ms - 500 + 7;  // between two samples
  const auto state = live.truth->state_at(live.flight_ns(asked_ms));
  ASSERT_TRUE(state.ok()) << state.error().message;
  ASSERT_TRUE(state->has_value());
  // ArduPilot's metres are not those of the ellipsoid: compared through the latitude.
  const Eigen::Vector3d expected = frame_at_start().world_from_geodetic(
      geodetic_from_deg(kLat0 + 1e-7 * 0.025 * asked_ms / 0.0111318845, kLon0, 600.0));
  EXPECT_LT(((*state)->T_world_body.translation - expected).norm(), 0.02);  // steps of 1e-7 deg
  EXPECT_LT(((*state)->v_body_world_m_s - Eigen::Vector3d(0, 25, 0)).norm(), 0.5);
  EXPECT_NEAR(
      attitude_from((*state)->T_world_body.rotation).yaw_rad, MadeVehicle::yaw_at(asked_ms), 1e-5);
  EXPECT_EQ((*state)->t_ns, live.flight_ns(asked_ms));
  EXPECT_THAT(live.truth->warnings(), ElementsAre());
}

TEST(LiveTruth, PrefersTheSimulatorsState) {
  const auto vehicle = listening_vehicle("udp-listen:127.0.0.1:0");
  MadeVehicle made(vehicle->address().port);
  std::atomic<bool> opened{false};
  std::thread flying([&] {
    made.heartbeat();
    for (std::uint32_t ms = 10000; !opened && ms < 60000; ms += 20) {
      made.state(ms);
      // Later than the estimate, within the time that is waited for it.
      if (ms > 11000) made.sim_state(ms);
      std::this_thread::sleep_for(milliseconds(1));
    }
  });
  LiveTruthOptions options;
  options.geoid_separation_m = 20.0;
  auto truth = LiveTruth::open(vehicle, frame_at_start(), options, nullptr);
  opened = true;
  flying.join();
  ASSERT_TRUE(truth.ok()) << truth.error().message;
  EXPECT_THAT((*truth)->description(), HasSubstr("the simulator's state (1.1/SIM_STATE)"));
  const auto state = (*truth)->state_at(0);
  ASSERT_TRUE(state.ok() && *state);
  const Geodetic point = frame_at_start().geodetic_from_world((*state)->T_world_body.translation);
  EXPECT_NEAR(point.alt_ellipsoid_m, 720.0, 1e-3);  // 700 m above the geoid
}

TEST(LiveTruth, ReportsGapsAndInterpolatesThem) {
  OpenedTruth live;
  ASSERT_NE(live.truth, nullptr);
  const std::uint32_t gap_ms = live.last_ms;
  live.last_ms += 3000;
  live.made->state(live.last_ms);
  live.made->state(live.last_ms + 20);  // a clock that jumps is believed after three stamps
  const std::uint32_t asked_ms = gap_ms + 1500;
  const auto state = live.truth->state_at(live.flight_ns(asked_ms));
  ASSERT_TRUE(state.ok() && *state);
  const Eigen::Vector3d expected = frame_at_start().world_from_geodetic(
      geodetic_from_deg(1e-7 * MadeVehicle::lat_at(asked_ms), kLon0, 600.0));
  // The Hermite polynomial of a straight flight is straight. ArduPilot's metres differ by 0.3 %.
  EXPECT_LT(((*state)->T_world_body.translation - expected).norm(), 0.1);
  const std::vector<std::string> warnings = live.truth->warnings();
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(warnings[0], HasSubstr("gaps between samples are longer than 0.500 s"));
  EXPECT_THAT(warnings[0], HasSubstr("is 3.000 s long"));
}

TEST(LiveTruth, TakesLateAndDoubleMessagesInTheirOrder) {
  OpenedTruth live;
  ASSERT_NE(live.truth, nullptr);
  const std::uint32_t begin_ms = live.last_ms;
  for (const std::uint32_t ms : {40U, 20U, 20U, 60U, 40U, 100U, 80U}) {
    live.made->state(begin_ms + ms);
  }
  for (std::uint32_t ms = 0; ms <= 80; ms += 10) {
    const auto state = live.truth->state_at(live.flight_ns(begin_ms + ms));
    ASSERT_TRUE(state.ok() && *state);
    const Eigen::Vector3d expected = frame_at_start().world_from_geodetic(
        geodetic_from_deg(1e-7 * MadeVehicle::lat_at(begin_ms + ms), kLon0, 600.0));
    EXPECT_LT(((*state)->T_world_body.translation - expected).norm(), 0.02) << ms;
    EXPECT_NEAR(attitude_from((*state)->T_world_body.rotation).yaw_rad,
                MadeVehicle::yaw_at(begin_ms + ms),
                1e-5);
  }
}

TEST(LiveTruth, ReportsJumpsOfPositions) {
  OpenedTruth live;
  ASSERT_NE(live.truth, nullptr);
  const std::uint32_t before_ms = live.last_ms;
  // 541 m in 40 ms, and back.
  live.made->attitude(before_ms + 40);
  live.made->position(before_ms + 40, before_ms + 40 + 21640);
  live.last_ms = before_ms + 60;
  live.fly_until(before_ms + 200);
  ASSERT_TRUE(live.truth->state_at(live.flight_ns(before_ms + 100)).ok());
  const std::vector<std::string> warnings = live.truth->warnings();
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(warnings[0],
              HasSubstr("2 jumps of the vehicle's positions, the largest by 541 m at"));
  EXPECT_THAT(warnings[0], HasSubstr("steps of more than 20 m and 150 m/s"));
}

/// Less than the two seconds that count as a restart.
TEST(LiveTruth, ReportsWhatIsLeftOutOfAClockThatIsSetBack) {
  OpenedTruth live;
  ASSERT_NE(live.truth, nullptr);
  const std::uint32_t begin_ms = live.last_ms;
  live.fly_until(begin_ms + 2000);
  ASSERT_TRUE(live.truth->state_at(live.flight_ns(begin_ms + 2000)).ok());
  live.last_ms -= 1000;
  live.fly_until(begin_ms + 2200);
  ASSERT_TRUE(live.truth->state_at(live.flight_ns(begin_ms + 2200)).ok());
  // Attitudes and positions of 49 instants; the fiftieth is the latest one.
  EXPECT_THAT(live.truth->warnings(),
              ElementsAre(HasSubstr("98 samples of the vehicle left out: earlier than the one "
                                    "before, the furthest by 0.980 s at")));
}

TEST(LiveTruth, EndsWhenTheVehicleRestarts) {
  OpenedTruth live;
  ASSERT_NE(live.truth, nullptr);
  live.fly_until(live.last_ms + 200);
  for (std::uint32_t ms = 100; ms < 300; ms += 20) live.made->state(ms);
  const auto known = live.truth->state_at(live.flight_ns(live.last_ms));
  ASSERT_TRUE(known.ok() && *known);
  const auto after = live.truth->state_at(live.flight_ns(live.last_ms) + 1);
  ASSERT_TRUE(after.ok()) << after.error().message;
  EXPECT_FALSE(after->has_value());
  ASSERT_EQ(live.truth->warnings().size(), 1U);
  EXPECT_THAT(live.truth->warnings()[0], HasSubstr("the vehicle was restarted"));
}

TEST(LiveTruth, WaitsOnWhenTheVehicleRestartsBeforeTheFlight) {
  for (const bool waits_for_item : {false, true}) {
    const auto vehicle = listening_vehicle("udp-listen:127.0.0.1:0");
    MadeVehicle made(vehicle->address().port);
    made.heartbeat();
    ASSERT_TRUE(vehicle->wait_until_heard(milliseconds(5000), nullptr).ok());
    LiveTruthOptions options;
    options.simulation_wait_ns = kNsPerS / 10;
    if (waits_for_item) options.start.mission_item = 5;
    std::atomic<bool> opened{false};
    std::thread flying([&] {
      // An hour after its start; without positions where the flight would begin with them.
      for (std::uint32_t ms = 3'600'000; ms < 3'610'000; ms += 20) {
        waits_for_item ? made.state(ms) : made.attitude(ms);
        std::this_thread::sleep_for(milliseconds(1));
      }
      for (std::uint32_t ms = 1000; !opened && ms < 60'000; ms += 20) {
        made.state(ms);
        if (waits_for_item && ms >= 3000 && ms % 500 == 0) {
          made.send(frame_bytes(42, PayloadWriter(18).put(0, std::uint16_t{5}).bytes(), 0));
        }
        std::this_thread::sleep_for(milliseconds(1));
      }
    });
    const auto truth = LiveTruth::open(vehicle, frame_at_start(), options, nullptr);
    opened = true;
    flying.join();
    ASSERT_TRUE(truth.ok()) << truth.error().message;
    const std::int64_t start_ns = (*truth)->start_ns();
    EXPECT_GE(start_ns, (waits_for_item ? 3 : 1) * kNsPerS);
    EXPECT_LT(start_ns, 60 * kNsPerS);
    EXPECT_THAT(
        (*truth)->warnings(),
        ::testing::ElementsAre(HasSubstr("the vehicle was restarted before its flight (1 time)")));
    const auto first = (*truth)->state_at(0);
    ASSERT_TRUE(first.ok() && *first);
    const auto start_ms = static_cast<std::uint32_t>(start_ns / 1'000'000);
    const Eigen::Vector3d expected = frame_at_start().world_from_geodetic(
        geodetic_from_deg(1e-7 * MadeVehicle::lat_at(start_ms), kLon0, 600.0));
    EXPECT_LT(((*first)->T_world_body.translation - expected).norm(), 0.02);
  }
}

TEST(LiveTruth, EndsByItsStopConditions) {
  LiveTruthOptions options;
  options.stop.on_disarm = true;
  OpenedTruth disarmed(options);
  ASSERT_NE(disarmed.truth, nullptr);
  disarmed.made->heartbeat(false);  // never armed while it was listened to
  disarmed.fly_until(disarmed.last_ms + 100);
  disarmed.made->heartbeat(true);
  disarmed.fly_until(disarmed.last_ms + 100);
  disarmed.made->heartbeat(false);
  const auto after = disarmed.truth->state_at(disarmed.flight_ns(disarmed.last_ms) + 1);
  ASSERT_TRUE(after.ok());
  EXPECT_FALSE(after->has_value());
  EXPECT_THAT(disarmed.truth->warnings().back(), HasSubstr("the vehicle was disarmed"));

  options = {};
  options.stop.mission_item = 7;
  OpenedTruth mission(options);
  ASSERT_NE(mission.truth, nullptr);
  for (const std::uint16_t item : {std::uint16_t{6}, std::uint16_t{7}}) {
    mission.made->send(frame_bytes(42, PayloadWriter(18).put(0, item).bytes(), 0));
  }
  EXPECT_FALSE(mission.truth->state_at(mission.flight_ns(mission.last_ms) + 1)->has_value());
  EXPECT_THAT(mission.truth->warnings().back(), HasSubstr("the mission has come to item 7"));
}

TEST(LiveTruth, BeginsWithAnItemOfTheMission) {
  const auto vehicle = listening_vehicle("udp-listen:127.0.0.1:0");
  MadeVehicle made(vehicle->address().port);
  made.heartbeat();
  LiveTruthOptions options;
  options.simulation_wait_ns = kNsPerS / 10;
  options.start.mission_item = 5;
  options.stop.mission_item = 9;
  /// The mission comes to the items of a list, one every 2 s of the vehicle's clock, from 12 s on.
  const auto open = [&](std::vector<std::uint16_t> items) {
    std::atomic<bool> opened{false};
    std::thread flying([&] {
      for (std::uint32_t ms = 10000; !opened && ms < 60000; ms += 20) {
        made.state(ms);
        const std::size_t item = ms / 2000 - 6;
        if (ms >= 12000 && ms % 2000 == 0 && item < items.size()) {
          made.send(frame_bytes(42, PayloadWriter(18).put(0, items[item]).bytes(), 0));
        }
        std::this_thread::sleep_for(milliseconds(1));
      }
    });
    auto truth = LiveTruth::open(vehicle, frame_at_start(), options, nullptr);
    opened = true;
    flying.join();
    return truth;
  };
  for (const std::vector<std::uint16_t>& items :
       {std::vector<std::uint16_t>{1, 4, 5}, std::vector<std::uint16_t>{1, 4, 6}}) {
    const auto truth = open(items);
    ASSERT_TRUE(truth.ok()) << truth.error().message;
    EXPECT_EQ((*truth)->start_ns(), 16 * kNsPerS);
    const auto first = (*truth)->state_at(0);
    ASSERT_TRUE(first.ok() && *first);
    const Eigen::Vector3d expected = frame_at_start().world_from_geodetic(
        geodetic_from_deg(1e-7 * MadeVehicle::lat_at(16000), kLon0, 600.0));
    EXPECT_LT(((*first)->T_world_body.translation - expected).norm(), 0.02);
  }
  const auto never = open({1, 9});
  ASSERT_FALSE(never.ok());
  EXPECT_THAT(
      never.error().message,
      HasSubstr("the flight ended before the mission came to item 5: the mission has come to "
                "item 9"));
}

TEST(LiveTruth, SaysWhatIsMissing) {
  LiveTruthOptions options;
  options.patience = milliseconds(100);
  OpenedTruth live(options);
  ASSERT_NE(live.truth, nullptr);
  const auto late = live.truth->state_at(live.flight_ns(live.last_ms) + kNsPerS);
  ASSERT_FALSE(late.ok());
  EXPECT_EQ(late.error().code, ErrorCode::kIo);
  EXPECT_THAT(late.error().message,
              HasSubstr("no new state within 0.1 s: the last message of vehicle 1.1"));
  const std::atomic<bool> cancel{true};
  EXPECT_EQ(live.truth->state_at(live.flight_ns(live.last_ms) + kNsPerS, &cancel).error().code,
            ErrorCode::kCancelled);

  const auto vehicle = listening_vehicle("udp-listen:127.0.0.1:0");
  auto silent = LiveTruth::open(vehicle, frame_at_start(), options, nullptr);
  ASSERT_FALSE(silent.ok());
  EXPECT_THAT(silent.error().message, HasSubstr("no message of the vehicle came within 0.1 s"));
  MadeVehicle made(vehicle->address().port);
  made.heartbeat();
  ASSERT_TRUE(vehicle->wait_until_heard(milliseconds(5000), nullptr).ok());
  options.truth = TruthPreference::kSimulation;
  auto real = LiveTruth::open(vehicle, frame_at_start(), options, nullptr);
  ASSERT_FALSE(real.ok());
  EXPECT_THAT(real.error().message, HasSubstr("the vehicle sends no SIM_STATE"));
}

}  // namespace
}  // namespace overfly::flight::live
