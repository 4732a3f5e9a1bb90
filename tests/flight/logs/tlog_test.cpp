#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "core/time.hpp"
#include "flight/logs/truth/log_trajectory.hpp"
#include "tests/flight/logs/log_bytes.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight::logs {
namespace {

using testing::append;
using testing::Bytes;
using ::testing::Contains;
using testing::frame_bytes;
using ::testing::HasSubstr;
using testing::put;
using testing::tlog_record;

constexpr std::uint64_t kReceivedUs = 1'700'000'000'000'000;

class TlogTest : public ::testing::Test {
 protected:
  /// Adds a message that arrives `received_ms` after the first one.
  void add(std::uint32_t id, const Bytes& payload, int received_ms, std::uint8_t system = 1) {
    append(bytes_,
           tlog_record(kReceivedUs + 1000 * static_cast<std::uint64_t>(received_ms),
                       frame_bytes(id, payload, sequences_[system]++, system)));
  }
  void add_attitude(std::uint32_t boot_ms, int received_ms, std::uint8_t system = 1) {
    add(30, testing::attitude_payload(boot_ms, 0.1F, 0.05F, 1.0F), received_ms, system);
  }
  void add_position(std::uint32_t boot_ms,
                    int received_ms,
                    double north_m,
                    std::uint8_t system = 1) {
    add(33,
        testing::global_position_payload(
            boot_ms, 470000000 + static_cast<std::int32_t>(north_m * 90.0), 80000000, 500000),
        received_ms,
        system);
  }
  Result<OpenedLog> open() {
    testing::write_bytes(file_, bytes_);
    return open_log(file_);
  }

  overfly::testing::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "flight.tlog";
  Bytes bytes_;
  std::array<std::uint8_t, 256> sequences_{};
};

std::vector<std::string> names_in(const OpenedLog& log) {
  std::vector<std::string> names;
  for (const StreamInfo& stream : log.streams) names.push_back(stream.description.name);
  return names;
}

TEST_F(TlogTest, ListsTheStreamsOfSeveralSystems) {
  for (int i = 0; i < 50; ++i) {
    add_attitude(1000 + 20 * static_cast<std::uint32_t>(i), 20 * i);
    add_position(1000 + 20 * static_cast<std::uint32_t>(i), 20 * i, 0.5 * i);
    add_attitude(900000 + 20 * static_cast<std::uint32_t>(i), 20 * i, 2);
    add(0, {0, 0, 0, 0, 6, 8, 0, 0, 3}, 20 * i, 255);
  }
  const auto log = open();
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->format, LogFormat::kTlog);
  EXPECT_THAT(names_in(*log),
              ::testing::ElementsAre(
                  "1.1/ATTITUDE", "1.1/GLOBAL_POSITION_INT", "2.1/ATTITUDE", "255.1/HEARTBEAT"));
  const StreamInfo& attitude = log->streams[0];
  EXPECT_EQ(attitude.messages, 50U);
  EXPECT_NEAR(attitude.rate_hz, 50.0, 1e-9);
  EXPECT_EQ(attitude.first_ns, 1'000'000'000);
  EXPECT_EQ(attitude.last_ns, 1'980'000'000);
  EXPECT_EQ(log->streams[2].first_ns, 900'000'000'000);  // a clock of its own
  EXPECT_EQ(log->streams[3].first_ns, std::nullopt);
  ASSERT_TRUE(log->truth);
  EXPECT_EQ(log->truth->position, 1U);
  EXPECT_EQ(log->truth->attitude, 0U);
  EXPECT_FALSE(log->on_ground);  // 25 m in 1 s
  EXPECT_EQ(log->boots.size(), 2U);
}

TEST_F(TlogTest, GivesMessagesWithoutTimeTheVehiclesClock) {
  Bytes sim;
  for (int i = 0; i < 21; ++i) put(sim, i == 0 ? 1.0F : 0.0F);
  const float alt_m = 600.0F;
  std::memcpy(sim.data() + 60, &alt_m, sizeof alt_m);
  put(sim, std::int32_t{470000000});
  put(sim, std::int32_t{80000000});
  for (int i = 0; i < 100; ++i) {
    // Times of reception that jump must not matter.
    add_attitude(1000 + 20 * static_cast<std::uint32_t>(i), 20 * i + (i % 2) * 700);
    std::int32_t lat = 470000000 + 45 * i;
    std::memcpy(sim.data() + 84, &lat, sizeof lat);
    add(108, sim, 20 * i + (i % 2) * 700 + 3);
  }
  const auto log = open();
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->streams[log->truth->position].description.name, "1.1/SIM_STATE");
  EXPECT_THAT(log->truth->reason, HasSubstr("simulator"));
  const auto trajectory = read_log_trajectory(*log, {});
  ASSERT_TRUE(trajectory.ok()) << trajectory.error().message;
  ASSERT_EQ(trajectory->poses.size(), 100U);
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(trajectory->poses[i].t_ns, (1000 + 20 * static_cast<std::int64_t>(i)) * 1'000'000);
    EXPECT_NEAR(trajectory->poses[i].position.x(), 47.0 + 45e-7 * static_cast<double>(i), 1e-12);
  }
  EXPECT_THAT(log->warnings, Contains(HasSubstr("received before the one in front")));
}

/// A level aircraft. @param lat  [1e-7 deg]
Bytes sim_state_payload(std::int32_t lat) {
  Bytes sim;
  for (int i = 0; i < 21; ++i) put(sim, i == 0 ? 1.0F : 0.0F);
  const float alt_m = 600.0F;
  std::memcpy(sim.data() + 60, &alt_m, sizeof alt_m);
  put(sim, lat);
  put(sim, std::int32_t{80000000});
  return sim;
}

/// Three stamps prove a restart: what has no time and comes between them belongs to the new run.
TEST_F(TlogTest, GivesMessagesWithoutTimeToTheRunThatIsProven) {
  const auto fly = [&](int count, std::uint32_t from_ms, std::int32_t from_lat) {
    for (int i = 0; i < count; ++i) {
      add_attitude(from_ms + 100 * static_cast<std::uint32_t>(i), 100 * i);
      add(108, sim_state_payload(from_lat + 90 * i), 100 * i);
    }
  };
  fly(40, 500000, 470000000);
  fly(20, 2000, 471000000);  // 11 km away
  const auto log = open();
  ASSERT_TRUE(log.ok()) << log.error().message;
  const StreamInfo& sim = log->streams[log->truth->position];
  EXPECT_EQ(sim.description.name, "1.1/SIM_STATE");
  EXPECT_EQ(sim.jumps, 0U);
  EXPECT_THAT(log->boots, ::testing::SizeIs(2));
  const auto trajectory = read_log_trajectory(*log, {});
  ASSERT_TRUE(trajectory.ok()) << trajectory.error().message;
  ASSERT_EQ(trajectory->poses.size(), 40U);
  EXPECT_NEAR(trajectory->poses.back().position.x(), 47.0 + 39 * 90e-7, 1e-9);
}

/// A damaged stamp is no restart: what follows it keeps the time in front of it.
TEST_F(TlogTest, KeepsMessagesWithoutTimeBehindADamagedStamp) {
  for (int i = 0; i < 40; ++i) {
    add_attitude(i == 20 ? 7 : 500000 + 100 * static_cast<std::uint32_t>(i), 100 * i);
    add(108, sim_state_payload(470000000 + 90 * i), 100 * i);
  }
  const auto log = open();
  ASSERT_TRUE(log.ok()) << log.error().message;
  const StreamInfo& sim = log->streams[log->truth->position];
  EXPECT_EQ(sim.messages, 40U);
  EXPECT_EQ(sim.first_ns, 500'000'000'000);
  EXPECT_EQ(sim.last_ns, 503'900'000'000);
  EXPECT_EQ(log->boots.size(), 1U);
}

TEST_F(TlogTest, SeparatesRestartsOfTheClock) {
  for (std::uint32_t i = 0; i < 30; ++i) {
    add_attitude(500000 + 100 * i, static_cast<int>(100 * i));
    add_position(500000 + 100 * i, static_cast<int>(100 * i), i);
  }
  for (std::uint32_t i = 0; i < 60; ++i) {
    add_attitude(2000 + 100 * i, static_cast<int>(20000 + 100 * i));
    add_position(2000 + 100 * i, static_cast<int>(20000 + 100 * i), i);
  }
  const auto log = open();
  ASSERT_TRUE(log.ok()) << log.error().message;
  ASSERT_EQ(log->boots.size(), 2U);
  EXPECT_THAT(log->warnings, Contains(HasSubstr("the clock of 1.1 starts again")));
  EXPECT_THAT(log->warnings, Contains(HasSubstr("2 stamps of messages are implausible")));
  const auto trajectory = read_log_trajectory(*log, {});
  ASSERT_TRUE(trajectory.ok()) << trajectory.error().message;
  EXPECT_LT(trajectory->poses.back().t_ns, 9 * kNsPerS);
  EXPECT_THAT(trajectory->warnings, Contains(HasSubstr("30 positions of 1 other runs")));
}

TEST_F(TlogTest, ReportsGapsJumpsAndTimeGoingBackward) {
  for (std::uint32_t i = 0; i < 100; ++i) {
    std::uint32_t boot_ms = 1000 + 100 * i;
    if (i >= 50) boot_ms += 3000;
    if (i == 70) boot_ms -= 500;
    add_attitude(boot_ms, static_cast<int>(100 * i));
    add_position(boot_ms, static_cast<int>(100 * i), i == 80 ? 5000.0 : 2.0 * i);
  }
  const auto log = open();
  ASSERT_TRUE(log.ok()) << log.error().message;
  const StreamInfo& position = log->streams[1];
  EXPECT_EQ(position.gaps, 1U);
  EXPECT_EQ(position.longest_gap_ns, 3'100'000'000);
  EXPECT_EQ(position.backward, 1U);
  EXPECT_EQ(position.jumps, 2U);
  EXPECT_NEAR(position.largest_jump_m, 4840.0, 60.0);
  EXPECT_FALSE(log->on_ground);
  const auto trajectory = read_log_trajectory(*log, {});
  ASSERT_TRUE(trajectory.ok()) << trajectory.error().message;
  EXPECT_THAT(trajectory->warnings, Contains(HasSubstr("1 positions were left out: not later")));
}

TEST_F(TlogTest, LeavesOutPositionsWithoutAFix) {
  for (std::uint32_t i = 0; i < 20; ++i) {
    add_attitude(1000 + 100 * i, static_cast<int>(100 * i));
    add(33,
        testing::global_position_payload(
            1000 + 100 * i, i < 5 ? 0 : 470000000, i < 5 ? 0 : 80000000, 500000),
        static_cast<int>(100 * i));
  }
  const auto log = open();
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->streams[1].positions, 15U);
  EXPECT_EQ(log->streams[1].invalid, 5U);
}

TEST_F(TlogTest, ListsModesArmingAndTexts) {
  add_attitude(1000, 0);
  add(0, {0, 0, 0, 0, 1, 3, 0x01, 4, 3}, 1);
  add(0, {10, 0, 0, 0, 1, 3, 0x81, 4, 3}, 2);
  Bytes text = {6};
  testing::put_text(text, "Ready to fly", 50);
  add(253, text, 3);
  add(46, {7, 0}, 4);
  const auto log = open();
  ASSERT_TRUE(log.ok()) << log.error().message;
  std::vector<std::string> texts;
  for (const LogEvent& event : log->events) {
    texts.push_back(event.text);
    ASSERT_TRUE(event.time);
    EXPECT_EQ(event.time->t_ns, kNsPerS);
  }
  EXPECT_THAT(texts,
              ::testing::ElementsAre("mode 0 (MANUAL)",
                                     "disarmed",
                                     "mode 10 (AUTO)",
                                     "armed",
                                     "Ready to fly",
                                     "reached mission item 7"));
  EXPECT_FALSE(log->truth);
  EXPECT_THAT(log->warnings, Contains(HasSubstr("no valid positions")));
}

TEST_F(TlogTest, NamesTheSourcesThereAre) {
  for (std::uint32_t i = 0; i < 5; ++i) {
    add_attitude(1000 + 100 * i, 0);
    add_position(1000 + 100 * i, 0, i);
    add_attitude(1000 + 100 * i, 0, 2);
    add_position(1000 + 100 * i, 0, i, 2);
  }
  const auto log = open();
  ASSERT_TRUE(log.ok()) << log.error().message;
  const auto wrong = read_log_trajectory(*log, {"SIM_STATE", {}, {}});
  ASSERT_FALSE(wrong.ok());
  EXPECT_THAT(wrong.error().message, HasSubstr("source SIM_STATE: must be one of"));
  EXPECT_THAT(wrong.error().message, HasSubstr("1.1/GLOBAL_POSITION_INT, 2.1/GLOBAL_POSITION_INT"));
  EXPECT_THAT(read_log_trajectory(*log, {"GLOBAL_POSITION_INT", {}, {}}).error().message,
              HasSubstr("several senders"));
  const auto second = read_log_trajectory(*log, {"2.1/GLOBAL_POSITION_INT", {}, {}});
  ASSERT_TRUE(second.ok()) << second.error().message;
  EXPECT_EQ(second->attitude_source, "2.1/ATTITUDE");
}

}  // namespace
}  // namespace overfly::flight::logs
