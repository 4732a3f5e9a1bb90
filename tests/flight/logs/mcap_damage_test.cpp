// MCAP files that are cut, damaged or hostile.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/flight/logs/mcap_fixture.hpp"

namespace overfly::flight::logs {
namespace {

using testing::append;
using testing::Bytes;
using ::testing::Contains;
using ::testing::HasSubstr;
using testing::mcap_channel;
using testing::mcap_chunk;
using testing::mcap_end;
using testing::mcap_message;
using testing::mcap_start;
using ::testing::Not;
using testing::Wire;

TEST_F(Mcap, LeavesOutChunksThatAreDamaged) {
  const Bytes raw = flight_records(Wire::kCdrLittle);
  const Bytes good = mcap_chunk(raw, raw.size(), crc_of(raw), "");
  const struct {
    const char* what;
    Bytes chunk;
    const char* warning;
  } cases[] = {
      {"checksum", mcap_chunk(raw, raw.size(), 1, ""), "1 chunks have a wrong checksum"},
      {"short", mcap_chunk(raw, raw.size() + 1, 0, ""), "1 chunks cannot be decompressed"},
      {"long", mcap_chunk(zstd_of(raw), 100, 0, "zstd"), "1 chunks cannot be decompressed"},
      {"no lz4", mcap_chunk(raw, raw.size(), 0, "lz4"), "1 chunks cannot be decompressed"},
      {"no zstd", mcap_chunk(raw, raw.size(), 0, "zstd"), "1 chunks cannot be decompressed"},
      {"unknown", mcap_chunk(raw, raw.size(), 0, "snappy"), "in a way that is not read"},
      {"huge", mcap_chunk(raw, ~std::uint64_t{0}, 0, "zstd"), "larger than 128 MiB"},
      {"a bomb",
       mcap_chunk(zstd_of(Bytes(std::size_t{50} << 20U, 0)), 1000, 0, "zstd"),
       "1 chunks cannot be decompressed"},
  };
  for (const auto& damaged : cases) {
    Bytes records = damaged.chunk;
    append(records, good);
    const auto log = open_bytes(whole_file(records));
    ASSERT_TRUE(log.ok()) << log.error().message;
    EXPECT_THAT(log->warnings, Contains(HasSubstr(damaged.warning))) << damaged.what;
    EXPECT_EQ(stream_named(*log, "/odom").positions, 20U) << damaged.what;
  }
}

TEST_F(Mcap, ReadsACutRecordingToTheLastWholeMessage) {
  const Bytes raw = flight_records(Wire::kCdrLittle, 2000);
  for (const bool compressed : {false, true}) {
    const Bytes stored = compressed ? zstd_of(raw) : raw;
    Bytes bytes = mcap_start("ros2");
    append(bytes, mcap_chunk(stored, raw.size(), crc_of(raw), compressed ? "zstd" : ""));
    bytes.resize(bytes.size() - stored.size() / 2);
    const auto log = open_bytes(bytes);
    ASSERT_TRUE(log.ok()) << log.error().message;
    // zstd's blocks hold 128 KiB, about 90 steps.
    EXPECT_NEAR(static_cast<double>(stream_named(*log, "/odom").positions), 1000.0, 150.0);
    EXPECT_THAT(log->warnings, Contains(HasSubstr("the recording has no end")));
  }
}

TEST_F(Mcap, ChecksTheDataSection) {
  Bytes bytes = mcap_start("ros2");
  append(bytes, flight_records(Wire::kCdrLittle));
  const std::uint32_t crc = crc_of(bytes);
  for (const bool right : {true, false}) {
    Bytes file = bytes;
    append(file, mcap_end(right ? crc : crc + 1));
    const auto log = open_bytes(file);
    ASSERT_TRUE(log.ok()) << log.error().message;
    const auto wrong = Contains(HasSubstr("checksum of the data section is wrong"));
    if (right) {
      EXPECT_THAT(log->warnings, Not(wrong));
    } else {
      EXPECT_THAT(log->warnings, wrong);
    }
  }
}

TEST_F(Mcap, RefusesOtherRepresentationsThanPlainCdr) {
  Bytes records = topic_declarations(Wire::kCdrLittle);
  Bytes message =
      testing::pose_stamped(Wire::kCdrLittle, kStartNs, {1, 2, 3}, Eigen::Quaterniond::Identity());
  message[1] = 3;
  append(records, mcap_message(1, 0, message));
  append(records, mcap_message(1, 0, message));
  const auto log = open_bytes(whole_file(records));
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_THAT(log->warnings,
              Contains(HasSubstr("2 messages have the CDR representation 0x0003 (PL_CDR), which is "
                                 "not read: only plain CDR (0x0000, 0x0001) is")));
  EXPECT_EQ(stream_named(*log, "/truth/pose").messages, 2U);
  EXPECT_EQ(stream_named(*log, "/truth/pose").positions, 0U);
}

TEST_F(Mcap, LeavesOutSamplesThatCannotBeRight) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const Wire wire = Wire::kRos1;
  const Eigen::Quaterniond level = Eigen::Quaterniond::Identity();
  Bytes records = topic_declarations(wire);
  append(records, mcap_message(1, 0, testing::pose_stamped(wire, kStartNs, {kNan, 0, 0}, level)));
  append(records,
         mcap_message(
             1,
             0,
             testing::pose_stamped(wire, kStartNs + 1, {1, 2, 3}, Eigen::Quaterniond(0, 0, 0, 0))));
  append(records, mcap_message(3, 0, testing::nav_sat_fix(wire, kStartNs, 47, 8, kNan)));
  append(records, mcap_message(3, 0, testing::nav_sat_fix(wire, kStartNs + 1, 47, 8, 500, -1)));
  append(records, mcap_message(4, 0, testing::imu_message(wire, kStartNs, level, -1.0)));
  // Shorter than its type; a text of 4 GB; a channel that is not declared; a message without
  // fields.
  append(records, mcap_message(4, 0, Bytes(30, 0)));
  append(records, mcap_message(2, 0, Bytes(16, 0xFF)));
  append(records, mcap_message(99, 0, Bytes(30, 0)));
  append(records, testing::mcap_record(0x05, {1, 2, 3}));
  const auto log = open_bytes(whole_file(records));
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(stream_named(*log, "/truth/pose").positions, 1U);
  EXPECT_EQ(stream_named(*log, "/truth/pose").invalid, 2U);
  EXPECT_EQ(stream_named(*log, "/gps/fix").invalid, 2U);
  EXPECT_EQ(stream_named(*log, "/imu/data").attitudes, 0U);
  EXPECT_EQ(stream_named(*log, "/imu/data").invalid, 0U);
  EXPECT_THAT(log->warnings, Contains(HasSubstr("2 messages are shorter than their type")));
  EXPECT_THAT(log->warnings, Contains(HasSubstr("1 messages belong to no channel")));
  EXPECT_THAT(log->warnings, Contains(HasSubstr("1 records have wrong lengths")));
}

TEST_F(Mcap, CannotBeMadeToTakeAnyNumberOfTopics) {
  Bytes records;
  for (int i = 0; i < 6000; ++i) {
    append(records,
           mcap_channel(static_cast<std::uint16_t>(i), 0, "/t" + std::to_string(i), "cdr"));
  }
  append(records, mcap_channel(7000, 0, std::string(5000, 'x'), "cdr"));
  const auto log = open_bytes(whole_file(records));
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->streams.size(), 4096U);
  EXPECT_THAT(log->warnings, Contains(HasSubstr("1904 declarations of topics were left out")));
  EXPECT_THAT(log->warnings, Contains(HasSubstr("1 records have wrong lengths")));
}

}  // namespace
}  // namespace overfly::flight::logs
