// Small logs of every format, cut at every byte, changed at random and made hostile: nothing may
// crash or hang, and what is in front of the damage must be read.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

#include "flight/logs/flight_log.hpp"
#include "flight/logs/truth/log_trajectory.hpp"
#include "tests/flight/logs/log_bytes.hpp"
#include "tests/flight/logs/ros_bytes.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight::logs {
namespace {

using testing::append;
using testing::Bytes;
using ::testing::HasSubstr;
using testing::put;

constexpr int kPairs = 12;

Bytes small_tlog() {
  Bytes bytes;
  for (int i = 0; i < kPairs; ++i) {
    const auto boot_ms = static_cast<std::uint32_t>(1000 + 100 * i);
    const auto sequence = static_cast<std::uint8_t>(2 * i);
    append(bytes,
           testing::tlog_record(
               1'700'000'000'000'000,
               testing::frame_bytes(30, testing::attitude_payload(boot_ms, 0.1F, 0, 0), sequence)));
    append(bytes,
           testing::tlog_record(1'700'000'000'000'000,
                                testing::frame_bytes(33,
                                                     testing::global_position_payload(
                                                         boot_ms, 470000000 + i, 80000000, 500000),
                                                     static_cast<std::uint8_t>(sequence + 1),
                                                     1,
                                                     mavlink::Version::kOne)));
  }
  return bytes;
}

Bytes small_dataflash() {
  Bytes bytes = testing::format_record(0x80, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns");
  append(bytes,
         testing::format_record(2, 29, "SIM", "QLLfccc", "TimeUS,Lat,Lng,Alt,Roll,Pitch,Yaw"));
  append(bytes, testing::format_record(4, 75, "MSG", "QZ", "TimeUS,Message"));
  for (int i = 0; i < kPairs; ++i) {
    Bytes record = testing::record_header(2);
    put(record, static_cast<std::uint64_t>(1'000'000 + 100'000 * i));
    put(record, std::int32_t{470000000 + i});
    put(record, std::int32_t{80000000});
    put(record, 500.0F);
    for (const std::int16_t value : {0, 0, 0}) put(record, value);
    append(bytes, record);
    Bytes text = testing::record_header(4);
    put(text, static_cast<std::uint64_t>(1'000'000 + 100'000 * i));
    testing::put_text(text, "some text", 64);
    append(bytes, text);
  }
  return bytes;
}

Bytes small_ulog() {
  Bytes bytes = testing::ulog_header();
  append(bytes, testing::ulog_text('F', "vehicle_attitude:uint64_t timestamp;float[4] q;"));
  append(bytes,
         testing::ulog_text('F',
                            "vehicle_global_position:uint64_t timestamp;double lat;"
                            "double lon;float alt;"));
  append(bytes, testing::ulog_subscription(0, 1, "vehicle_attitude"));
  append(bytes, testing::ulog_subscription(0, 2, "vehicle_global_position"));
  for (int i = 0; i < kPairs; ++i) {
    const auto time_us = static_cast<std::uint64_t>(1'000'000 + 100'000 * i);
    Bytes attitude;
    put(attitude, time_us);
    for (const float value : {1.0F, 0.0F, 0.0F, 0.0F}) put(attitude, value);
    append(bytes, testing::ulog_data(1, attitude));
    Bytes position;
    put(position, time_us);
    put(position, 47.0 + 1e-6 * i);
    put(position, 8.0);
    put(position, 500.0F);
    append(bytes, testing::ulog_data(2, position));
  }
  return bytes;
}

/// Its chunk is not compressed: a changed byte then seldom makes the whole of it unreadable.
Bytes small_mcap() {
  using testing::Wire;
  Bytes records = testing::mcap_schema(1, "geometry_msgs/msg/PoseStamped");
  append(records, testing::mcap_channel(1, 1, "/pose", "cdr"));
  for (int i = 0; i < 2 * kPairs; ++i) {
    const std::int64_t t_ns = 1'000'000'000 + std::int64_t{100'000'000} * i;
    append(records,
           testing::mcap_message(
               1,
               1000,
               testing::pose_stamped(
                   Wire::kCdrLittle, t_ns, {1.0 * i, 2.0, 3.0}, Eigen::Quaterniond::Identity())));
  }
  Bytes bytes = testing::mcap_start("ros2");
  append(bytes, testing::mcap_chunk(records, records.size(), 0, ""));
  append(bytes, testing::mcap_end());
  return bytes;
}

Bytes small_rosbag() {
  using testing::Wire;
  Bytes records = testing::bag_connection(0, "/pose", "geometry_msgs/PoseStamped");
  for (int i = 0; i < 2 * kPairs; ++i) {
    const std::int64_t t_ns = 1'000'000'000 + std::int64_t{100'000'000} * i;
    append(records,
           testing::bag_message(
               0,
               t_ns,
               testing::pose_stamped(
                   Wire::kRos1, t_ns, {1.0 * i, 2.0, 3.0}, Eigen::Quaterniond::Identity())));
  }
  Bytes bytes = testing::bag_start(1);
  append(bytes, testing::bag_chunk("none", static_cast<std::uint32_t>(records.size()), records));
  return bytes;
}

Bytes small_lcm() {
  Bytes bytes;
  for (int i = 0; i < 2 * kPairs; ++i) {
    append(bytes,
           testing::lcm_event(i,
                              1'700'000'000'000'000,
                              "TRUTH",
                              testing::lcm_truth(std::int64_t{100'000'000} * i,
                                                 {1.0 * i, 2.0, 3.0},
                                                 Eigen::Quaterniond::Identity())));
  }
  return bytes;
}

struct Format {
  const char* name;
  Bytes (*bytes)();
};

class DamagedLogs : public ::testing::TestWithParam<Format> {
 protected:
  /// Opens and converts. @return the number of messages that were read
  std::uint64_t read(const Bytes& bytes) {
    testing::write_bytes(file_, bytes);
    const auto log = open_log(file_);
    if (!log.ok()) {
      EXPECT_FALSE(log.error().message.empty());
      return 0;
    }
    std::uint64_t messages = 0;
    for (const StreamInfo& stream : log->streams) messages += stream.messages;
    const auto trajectory = read_log_trajectory(*log, {});
    if (trajectory.ok()) {
      EXPECT_FALSE(trajectory->poses.empty());
      for (std::size_t i = 1; i < trajectory->poses.size(); ++i) {
        EXPECT_GT(trajectory->poses[i].t_ns, trajectory->poses[i - 1].t_ns);
      }
      EXPECT_TRUE(write_log_tum(folder_.path() / "out.tum", *trajectory).ok());
    }
    return messages;
  }

  overfly::testing::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "flight.log";
};

TEST_P(DamagedLogs, AreReadUpToTheCut) {
  const Bytes whole = GetParam().bytes();
  std::uint64_t before = 0;
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    const std::uint64_t messages = read(cut);
    // DataFlash believes a record only if another one or the end of the file follows.
    EXPECT_GE(messages + 1, before) << size;
    before = std::max(before, messages);
  }
  EXPECT_EQ(before, read(whole));
  EXPECT_GE(before, std::uint64_t{2 * kPairs});
}

TEST_P(DamagedLogs, WithRandomChangesAreReported) {
  const Bytes whole = GetParam().bytes();
  const std::uint64_t all = read(whole);
  std::uint64_t state = 88172645463325252ULL;  // xorshift64 (Marsaglia 2003)
  const auto random = [&](std::size_t limit) {
    state ^= state << 13U;
    state ^= state >> 7U;
    state ^= state << 17U;
    return static_cast<std::size_t>(state % limit);
  };
  for (int round = 0; round < 300; ++round) {
    Bytes bytes = whole;
    const std::size_t changes = 1 + random(8);
    for (std::size_t i = 0; i < changes; ++i) {
      bytes[random(bytes.size())] = static_cast<std::uint8_t>(random(256));
    }
    if (round % 3 == 0) {
      const std::size_t at = random(bytes.size());
      bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(at));
    }
    EXPECT_LE(read(bytes), all + 4) << round;
  }
  for (int round = 0; round < 50; ++round) {
    Bytes noise(2000);
    for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random(256));
    std::copy_n(whole.begin(), 40, noise.begin());
    read(noise);
  }
}

INSTANTIATE_TEST_SUITE_P(AllFormats,
                         DamagedLogs,
                         ::testing::Values(Format{"tlog", small_tlog},
                                           Format{"dataflash", small_dataflash},
                                           Format{"ulog", small_ulog},
                                           Format{"mcap", small_mcap},
                                           Format{"rosbag", small_rosbag},
                                           Format{"lcm", small_lcm}),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

TEST(HostileLogs, CannotMakeAnyNumberOfStreams) {
  // Every FMT record declares type 2 with another name.
  Bytes bytes = testing::format_record(0x80, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns");
  for (int i = 0; i < 6000; ++i) {
    const std::string name = {static_cast<char>('A' + i % 26),
                              static_cast<char>('A' + i / 26 % 26),
                              static_cast<char>('A' + i / 676)};
    append(bytes, testing::format_record(2, 4, name, "B", "X"));
    append(bytes, {0xA3, 0x95, 2, 0});
  }
  const overfly::testing::TemporaryFolder folder;
  testing::write_bytes(folder.path() / "a.bin", bytes);
  const auto log = open_log(folder.path() / "a.bin");
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_LE(log->streams.size(), 4096U);
  EXPECT_THAT(log->warnings, ::testing::Contains(HasSubstr("only 4096 streams are read")));
}

TEST(HostileLogs, KeepEventsWithinTheirLimit) {
  Bytes bytes = small_dataflash();
  for (std::size_t i = 0; i < kMaxEvents + 5; ++i) {
    Bytes text = testing::record_header(4);
    put(text, std::uint64_t{2'000'000});
    testing::put_text(text, "again", 64);
    append(bytes, text);
  }
  const overfly::testing::TemporaryFolder folder;
  testing::write_bytes(folder.path() / "a.bin", bytes);
  const auto log = open_log(folder.path() / "a.bin");
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->events.size(), kMaxEvents);
  EXPECT_THAT(log->warnings, ::testing::Contains(HasSubstr("17 events were left out")));
}

TEST(OpenLog, NamesWhatIsNoLog) {
  const overfly::testing::TemporaryFolder folder;
  EXPECT_EQ(open_log(folder.path() / "absent.bin").error().code, ErrorCode::kNotFound);
  EXPECT_THAT(open_log(folder.path()).error().message, HasSubstr("is a folder"));
  overfly::testing::write_text(folder.path() / "a.txt", "hello");
  const auto text = open_log(folder.path() / "a.txt");
  ASSERT_FALSE(text.ok());
  EXPECT_EQ(text.error().code, ErrorCode::kUnreadable);
  EXPECT_THAT(text.error().message, HasSubstr("a.txt: is not a flight log"));
  EXPECT_FALSE(open_log("/dev/zero").ok());
}

TEST(OpenLog, RecognisesAFormatBehindDamage) {
  const overfly::testing::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "a";
  for (const Format& format : {Format{"tlog", small_tlog}, Format{"dataflash", small_dataflash}}) {
    Bytes bytes(300, 0x5A);
    append(bytes, format.bytes());
    testing::write_bytes(file, bytes);
    const auto log = open_log(file);
    ASSERT_TRUE(log.ok()) << log.error().message;
    EXPECT_STREQ(to_string(log->format), format.name);
    EXPECT_THAT(log->warnings, ::testing::Contains(HasSubstr("300 bytes")));
  }
  // MAVLink without the time stamps of a .tlog
  Bytes link;
  for (std::uint8_t i = 0; i < 20; ++i) {
    append(link, testing::frame_bytes(30, testing::attitude_payload(i, 0.1F, 0, 0), i));
  }
  testing::write_bytes(file, link);
  EXPECT_THAT(open_log(file).error().message, HasSubstr("is not a flight log"));
}

TEST(OpenLog, StopsWhenCancelled) {
  const overfly::testing::TemporaryFolder folder;
  testing::write_bytes(folder.path() / "a.tlog", small_tlog());
  const std::atomic<bool> cancel = true;
  EXPECT_EQ(open_log(folder.path() / "a.tlog", &cancel).error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace overfly::flight::logs
