// Stamps of a clock may be wrong, also the first: what follows must not look like a restart or a
// gap.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "core/text/number_text.hpp"
#include "core/time.hpp"
#include "flight/logs/log_samples.hpp"
#include "flight/logs/truth/log_trajectory.hpp"
#include "flight/replay/flight_events.hpp"
#include "tests/flight/logs/ros_bytes.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight::logs {
namespace {

using testing::append;
using testing::Bytes;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::put;

constexpr int kMessages = 30;

std::int64_t seconds_ns(double t_s) { return static_cast<std::int64_t>(t_s * 1e9); }

/// What each log has: kMessages samples at 10 Hz from 1000 s on, but for one stamp and a gap.
struct LogStamps {
  int odd = 0;  ///< the sample with another stamp
  std::int64_t odd_ns = 1000 * kNsPerS;
  std::int64_t gap_ns = 0;  ///< in front of sample 15

  [[nodiscard]] std::int64_t of(int i) const {
    if (i == odd) return odd_ns;
    return 1000 * kNsPerS + i * kNsPerS / 10 + (i >= 15 ? gap_ns : 0);
  }
};
using LogMaker = std::function<Bytes(const LogStamps& stamps)>;

Bytes dataflash_of(const LogStamps& stamps) {
  Bytes bytes = testing::format_record(0x80, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns");
  append(bytes,
         testing::format_record(2, 29, "SIM", "QLLfccc", "TimeUS,Lat,Lng,Alt,Roll,Pitch,Yaw"));
  for (int i = 0; i < kMessages; ++i) {
    Bytes record = testing::record_header(2);
    put(record, static_cast<std::uint64_t>(stamps.of(i) / 1000));
    put(record, 470000000 + 900 * i);
    put(record, std::int32_t{80000000});
    put(record, 500.0F);
    for (const std::int16_t angle : {1000, 0, 0}) put(record, angle);
    append(bytes, record);
  }
  return bytes;
}

Bytes ulog_of(const LogStamps& stamps) {
  Bytes bytes = testing::ulog_header();
  append(bytes,
         testing::ulog_text('F',
                            "vehicle_gps_position:uint64_t timestamp;int32_t lat;"
                            "int32_t lon;int32_t alt;uint8_t fix_type;"));
  append(bytes, testing::ulog_text('F', "vehicle_attitude:uint64_t timestamp;float[4] q;"));
  append(bytes, testing::ulog_subscription(0, 1, "vehicle_gps_position"));
  append(bytes, testing::ulog_subscription(0, 2, "vehicle_attitude"));
  for (int i = 0; i < kMessages; ++i) {
    const auto time_us = static_cast<std::uint64_t>(stamps.of(i) / 1000);
    Bytes gps;
    put(gps, time_us);
    for (const std::int32_t value : {470000000 + 900 * i, 80000000, 500000}) put(gps, value);
    gps.push_back(3);
    append(bytes, testing::ulog_data(1, gps));
    if (i == stamps.odd) continue;  // one stamp is wrong, not two
    Bytes attitude;
    put(attitude, time_us);
    for (const float value : {1.0F, 0.0F, 0.0F, 0.0F}) put(attitude, value);
    append(bytes, testing::ulog_data(2, attitude));
  }
  return bytes;
}

/// The position's clock is not that of the attitudes, which are all right.
Bytes rosbag_of(const LogStamps& stamps) {
  Bytes bytes = testing::bag_start(1);
  append(bytes, testing::bag_connection(0, "/fix", "sensor_msgs/NavSatFix"));
  append(bytes, testing::bag_connection(1, "/imu", "sensor_msgs/Imu"));
  for (int i = 0; i < kMessages; ++i) {
    const auto wire = testing::Wire::kRos1;
    const std::int64_t t_ns = 1000 * kNsPerS + i * kNsPerS / 10 + (i >= 15 ? stamps.gap_ns : 0);
    append(bytes,
           testing::bag_message(
               0, t_ns, testing::nav_sat_fix(wire, stamps.of(i), 47.0 + 9e-5 * i, 8.0, 500.0)));
    append(bytes,
           testing::bag_message(
               1, t_ns, testing::imu_message(wire, t_ns, Eigen::Quaterniond::Identity())));
  }
  return bytes;
}

Bytes lcm_of(const LogStamps& stamps) {
  Bytes bytes;
  for (int i = 0; i < kMessages; ++i) {
    append(bytes,
           testing::lcm_event(
               i,
               1'700'000'000'000'000 + 100'000 * i,
               "TRUTH",
               testing::lcm_truth(
                   stamps.of(i), {1.0 * i, 20.0 * i, 300.0}, Eigen::Quaterniond::Identity())));
  }
  return bytes;
}

Bytes tlog_of(const LogStamps& stamps) {
  Bytes bytes;
  std::uint8_t sequence = 0;
  for (int i = 0; i < kMessages; ++i) {
    const auto received_us = static_cast<std::uint64_t>(1'700'000'000'000'000 + 100'000 * i);
    const auto boot_ms = static_cast<std::uint32_t>(stamps.of(i) / 1'000'000);
    const Bytes position =
        testing::global_position_payload(boot_ms, 470000000 + 900 * i, 80000000, 500000);
    append(bytes,
           testing::tlog_record(received_us, testing::frame_bytes(33, position, sequence++)));
    if (i == stamps.odd) continue;
    append(bytes,
           testing::tlog_record(
               received_us,
               testing::frame_bytes(30, testing::attitude_payload(boot_ms, 0, 0, 0), sequence++)));
  }
  return bytes;
}

struct StampedLog {
  const char* name;
  LogMaker make;
};

class Stamps : public ::testing::TestWithParam<StampedLog> {
 protected:
  Result<OpenedLog> open(const LogStamps& stamps) {
    testing::write_bytes(folder_.path() / "log", GetParam().make(stamps));
    return open_log(folder_.path() / "log");
  }
  overfly::testing::TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Logs,
                         Stamps,
                         ::testing::Values(StampedLog{"DataFlash", dataflash_of},
                                           StampedLog{"ULog", ulog_of},
                                           StampedLog{"Rosbag", rosbag_of},
                                           StampedLog{"Lcm", lcm_of},
                                           StampedLog{"Tlog", tlog_of}),
                         [](const auto& tested) { return std::string(tested.param.name); });

/// Of a clock that is set after its first message, and of a bit that flipped.
TEST_P(Stamps, LeaveOutAFirstOneThatIsWrong) {
  for (const std::int64_t first_ns : {std::int64_t{0}, 4'000'000 * kNsPerS}) {
    const auto log = open({0, first_ns});
    ASSERT_TRUE(log.ok()) << log.error().message;
    for (const BootInfo& boot : log->boots) EXPECT_EQ(boot.number, 0U);
    EXPECT_THAT(log->warnings, Not(Contains(HasSubstr("starts again"))));
    // The wrong one, and two until the others are believed.
    EXPECT_THAT(log->warnings, Contains(HasSubstr("3 stamps of ")));
    const auto trajectory = read_log_trajectory(*log, {});
    ASSERT_TRUE(trajectory.ok()) << trajectory.error().message;
    EXPECT_THAT(trajectory->warnings, Not(Contains(HasSubstr("other runs of the clock"))));
    EXPECT_GE(trajectory->poses.size(), std::size_t{kMessages - 4});
    EXPECT_GE(trajectory->poses.front().t_ns, 1000 * kNsPerS);
    const auto samples = read_log_samples(*log, {});
    ASSERT_TRUE(samples.ok()) << samples.error().message;
    EXPECT_GE(samples->positions.front().t_ns, 1000 * kNsPerS);
  }
}

TEST_P(Stamps, KeepAFirstOneThatIsRightWithAllOthers) {
  const auto log = open({});
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_THAT(log->warnings, Not(Contains(HasSubstr("implausible"))));
  const StreamInfo& source = log->streams[log->truth->position];
  EXPECT_EQ(source.positions, static_cast<std::uint64_t>(kMessages));
  EXPECT_EQ(source.first_ns, 1000 * kNsPerS);
}

/// Also the sample itself: it would push all others out up to its time.
TEST_P(Stamps, LeaveOutOneThatIsAhead) {
  for (const double ahead_s : {2.5, 9.0, 300.0}) {
    const auto log = open({10, seconds_ns(1001.0 + ahead_s)});
    ASSERT_TRUE(log.ok()) << log.error().message;
    for (const BootInfo& boot : log->boots) EXPECT_EQ(boot.number, 0U);
    EXPECT_THAT(log->warnings, Not(Contains(HasSubstr("starts again"))));
    EXPECT_THAT(log->warnings, Contains(HasSubstr("3 stamps of ")));
    EXPECT_LT(*log->streams[log->truth->position].last_ns, seconds_ns(1003.0));
    const auto trajectory = read_log_trajectory(*log, {});
    ASSERT_TRUE(trajectory.ok()) << trajectory.error().message;
    EXPECT_GE(trajectory->poses.size(), std::size_t{kMessages - 4});
    EXPECT_LT(trajectory->poses.back().t_ns, seconds_ns(1003.0));
    const auto samples = read_log_samples(*log, {});
    ASSERT_TRUE(samples.ok()) << samples.error().message;
    EXPECT_GE(samples->positions.size(), std::size_t{kMessages - 3});
  }
}

TEST_P(Stamps, KeepAllAfterAGap) {
  for (const double gap_s : {5.0, 100.0}) {
    const auto log = open({.gap_ns = seconds_ns(gap_s)});
    ASSERT_TRUE(log.ok()) << log.error().message;
    EXPECT_THAT(log->warnings, Not(Contains(HasSubstr("implausible"))));
    const StreamInfo& source = log->streams[log->truth->position];
    EXPECT_EQ(source.positions, static_cast<std::uint64_t>(kMessages));
    EXPECT_EQ(source.last_ns, seconds_ns(1002.9 + gap_s));
  }
}

TEST(FirstStampOfACsvFile, ThatIsWrongIsLeftOut) {
  const overfly::testing::TemporaryFolder folder;
  overfly::testing::write_text(folder.path() / "log.json", R"({"csv_mapping_version": 1, "pieces": [
    {"name": "GPS", "file": "gps.csv", "origin": "gps", "time": {"column": "t", "unit": "s"},
     "columns": {"lat": {"column": "lat", "unit": "deg"}, "lon": {"column": "lon", "unit": "deg"},
                 "alt_msl": {"column": "alt", "unit": "m"}}}]})");
  std::string rows = "t,lat,lon,alt\n0,47,8,500\n";
  for (int i = 1; i < kMessages; ++i) {
    rows += number_text(1000 + 0.1 * i) + "," + number_text(47 + 9e-5 * i) + ",8,500\n";
  }
  overfly::testing::write_text(folder.path() / "gps.csv", rows);
  const auto log = open_log(folder.path() / "log.json");
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_THAT(log->warnings, Contains(HasSubstr("3 rows with an implausible time")));
  EXPECT_EQ(log->streams[0].first_ns, seconds_ns(1000.3));
}

TEST(FirstStamps, OfTwoMessagesInAllAreKept) {
  const overfly::testing::TemporaryFolder folder;
  Bytes bytes = dataflash_of({});
  constexpr std::size_t kRecordBytes = 29;
  bytes.resize(bytes.size() - (kMessages - 2) * kRecordBytes);
  testing::write_bytes(folder.path() / "log", bytes);
  const auto log = open_log(folder.path() / "log");
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->streams[1].positions, 2U);
  EXPECT_EQ(log->streams[1].last_ns, seconds_ns(1000.1));
}

/// A heartbeat has no time, and usually comes before the first message that has one.
TEST(FirstMode, OfAVehicleIsInForceFromItsFirstTime) {
  Bytes bytes;
  std::uint8_t sequence = 0;
  const auto add = [&](std::uint32_t id, const Bytes& payload) {
    append(bytes,
           testing::tlog_record(1'700'000'000'000'000 + 1000ULL * sequence,
                                testing::frame_bytes(id, payload, sequence)));
    ++sequence;
  };
  add(0, {10, 0, 0, 0, 1, 3, 0x81, 4, 3});  // AUTO, armed
  add(42, {7, 0});                          // MISSION_CURRENT
  for (std::uint32_t i = 0; i < 20; ++i) {
    add(30, testing::attitude_payload(5000 + 100 * i, 0.1F, 0.0F, 1.0F));
    add(33,
        testing::global_position_payload(
            5000 + 100 * i, 470000000 + 900 * static_cast<std::int32_t>(i), 80000000, 500000));
  }
  const overfly::testing::TemporaryFolder folder;
  testing::write_bytes(folder.path() / "log", bytes);
  const auto log = open_log(folder.path() / "log");
  ASSERT_TRUE(log.ok()) << log.error().message;
  ASSERT_EQ(log->events.size(), 3U);
  for (const LogEvent& event : log->events) {
    ASSERT_TRUE(event.time) << event.text;
    EXPECT_EQ(event.time->t_ns, 5 * kNsPerS);
  }
  const auto events = events_of(*log, "1.1/GLOBAL_POSITION_INT", 0, 5 * kNsPerS, 7 * kNsPerS);
  ASSERT_EQ(events.size(), 3U);
  EXPECT_EQ(events[0].text, "AUTO");
}

TEST(FirstMode, OfAVehicleWithoutAnyTimeIsListedWithoutOne) {
  const overfly::testing::TemporaryFolder folder;
  const Bytes frame = testing::frame_bytes(0, {10, 0, 0, 0, 1, 3, 0x81, 4, 3}, 0);
  testing::write_bytes(folder.path() / "log", testing::tlog_record(1'700'000'000'000'000, frame));
  const auto log = open_log(folder.path() / "log");
  ASSERT_TRUE(log.ok()) << log.error().message;
  ASSERT_EQ(log->events.size(), 2U);
  EXPECT_FALSE(log->events[0].time);
}

}  // namespace
}  // namespace overfly::flight::logs
