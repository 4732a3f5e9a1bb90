#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/motion/pose.hpp"
#include "core/time.hpp"
#include "flight/logs/truth/log_trajectory.hpp"
#include "flight/logs/ulog/ulog_format.hpp"
#include "tests/flight/logs/log_bytes.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight::logs {
namespace {

using testing::append;
using testing::Bytes;
using ::testing::Contains;
using ::testing::HasSubstr;
using testing::put;
using testing::ulog_data;
using testing::ulog_header;
using testing::ulog_message;
using testing::ulog_subscription;
using testing::ulog_text;

Bytes flag_bits(std::uint8_t incompatible, std::uint64_t appended) {
  Bytes body(16, 0);
  body[8] = incompatible;
  put(body, appended);
  put(body, std::uint64_t{0});
  put(body, std::uint64_t{0});
  return ulog_message('B', body);
}

Bytes definitions(std::uint8_t incompatible = 0, std::uint64_t appended = 0) {
  Bytes bytes = ulog_header();
  append(bytes, flag_bits(incompatible, appended));
  append(bytes,
         ulog_text('F',
                   "vehicle_attitude:uint64_t timestamp;uint64_t timestamp_sample;"
                   "float[4] q;uint8_t quat_reset_counter;uint8_t[7] _padding0;"));
  append(bytes,
         ulog_text('F',
                   "vehicle_local_position:uint64_t timestamp;double ref_lat;"
                   "double ref_lon;float x;float y;float z;float ref_alt;bool xy_valid;"
                   "bool z_valid;bool xy_global;bool z_global;"));
  append(bytes,
         ulog_text('F',
                   "vehicle_gps_position:uint64_t timestamp;int32_t lat;int32_t lon;"
                   "int32_t alt;uint8_t fix_type;"));
  append(bytes,
         ulog_text('F',
                   "vehicle_status:uint64_t timestamp;uint8_t nav_state;"
                   "uint8_t arming_state;"));
  append(bytes, ulog_subscription(0, 1, "vehicle_attitude"));
  append(bytes, ulog_subscription(0, 2, "vehicle_local_position"));
  append(bytes, ulog_subscription(0, 3, "vehicle_gps_position"));
  append(bytes, ulog_subscription(0, 4, "vehicle_status"));
  return bytes;
}

Bytes attitude_message(std::uint64_t time_us, double roll_rad) {
  Bytes data;
  put(data, time_us);
  put(data, time_us);
  for (const double value : {std::cos(roll_rad / 2.0), std::sin(roll_rad / 2.0), 0.0, 0.0}) {
    put(data, static_cast<float>(value));
  }
  data.push_back(0);  // the padding is left out, as PX4 does
  return ulog_data(1, data);
}

Bytes local_position(std::uint64_t time_us, float north_m, bool global = true) {
  Bytes data;
  put(data, time_us);
  put(data, 47.0);
  put(data, 8.0);
  for (const float value : {north_m, 10.0F, -100.0F, 400.0F}) put(data, value);
  for (const bool flag : {true, true, global, global}) data.push_back(flag ? 1 : 0);
  return ulog_data(2, data);
}

Bytes gps(std::uint64_t time_us, std::uint8_t fix) {
  Bytes data;
  put(data, time_us);
  for (const std::int32_t value : {470000000, 80000000, 500000}) put(data, value);
  data.push_back(fix);
  return ulog_data(3, data);
}

Bytes status(std::uint64_t time_us, std::uint8_t mode, std::uint8_t arming) {
  Bytes data;
  put(data, time_us);
  data.push_back(mode);
  data.push_back(arming);
  return ulog_data(4, data);
}

Bytes flight(int count) {
  Bytes bytes;
  for (int i = 0; i < count; ++i) {
    const auto time_us = static_cast<std::uint64_t>(2'000'000 + 10'000 * i);
    append(bytes, attitude_message(time_us, 0.01 * i));
    append(bytes, local_position(time_us + 5'000, static_cast<float>(i)));
    if (i % 10 == 0) append(bytes, gps(time_us, i < 30 ? 2 : 3));
  }
  return bytes;
}

Result<OpenedLog> open_ulog(const overfly::testing::TemporaryFolder& folder, const Bytes& bytes) {
  testing::write_bytes(folder.path() / "flight.ulg", bytes);
  return open_log(folder.path() / "flight.ulg");
}

TEST(UlogFormats, FindsFieldsOfNestedTypes) {
  UlogFormats formats;
  EXPECT_TRUE(formats.declare("outer:uint64_t timestamp;inner[3] parts;float end;"));
  EXPECT_TRUE(formats.declare("inner:uint8_t kind;float[2] xy;"));
  const auto xy = formats.find("outer", "parts[1].xy");
  ASSERT_TRUE(xy);
  EXPECT_EQ(xy->offset, 8U + 9U + 1U);
  EXPECT_EQ(xy->count, 2U);
  EXPECT_EQ(formats.find("outer", "end")->offset, 8U + 27U);
  EXPECT_FALSE(formats.find("outer", "parts[3].xy"));
  EXPECT_FALSE(formats.find("outer", "parts"));
  EXPECT_FALSE(formats.find("outer", "absent"));
  EXPECT_FALSE(formats.find("absent", "x"));
}

TEST(UlogFormats, RejectsWhatItCannotUnderstand) {
  UlogFormats formats;
  for (const char* text : {"",
                           ":float x;",
                           "a",
                           "a:float;",
                           "a:float[ x;",
                           "a:float[-1] x;",
                           "a:float[99999999999999999999] x;",
                           "a:[3] x;"}) {
    EXPECT_FALSE(formats.declare(text)) << text;
  }
  std::string wide = "wide:";
  for (int i = 0; i < 1025; ++i) wide += "bool b" + std::to_string(i) + ";";
  EXPECT_FALSE(formats.declare(wide));
  EXPECT_TRUE(formats.declare("loop:loop next;float x;"));
  EXPECT_FALSE(formats.find("loop", "x"));
  EXPECT_TRUE(formats.declare("large:float[60000] a;float x;"));
  EXPECT_TRUE(formats.declare("larger:large[60000] a;float x;"));
  EXPECT_FALSE(formats.find("larger", "x"));
}

TEST(Ulog, ReadsAFlight) {
  Bytes bytes = definitions();
  append(bytes, flight(100));
  append(bytes, status(2'100'000, 3, 1));
  append(bytes, status(2'200'000, 3, 2));
  append(bytes, status(2'300'000, 5, 2));
  Bytes text = {'6'};
  put(text, std::uint64_t{2'400'000});
  for (const char letter : std::string("Takeoff detected")) {
    text.push_back(static_cast<std::uint8_t>(letter));
  }
  append(bytes, ulog_message('L', text));
  append(bytes, ulog_message('O', {100, 0}));
  const overfly::testing::TemporaryFolder folder;
  const auto log = open_ulog(folder, bytes);
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->format, LogFormat::kUlog);
  const StreamInfo& position = log->streams[1];
  EXPECT_EQ(position.description.name, "vehicle_local_position[0]");
  EXPECT_TRUE(position.georeferenced);
  EXPECT_NEAR(position.rate_hz, 100.0, 1e-9);
  EXPECT_EQ(log->streams[2].positions, 7U);
  EXPECT_EQ(log->streams[2].invalid, 3U);
  EXPECT_EQ(log->truth->position, 1U);
  EXPECT_THAT(log->warnings, Contains(HasSubstr("1 dropouts of the logger, 100 ms")));
  std::vector<std::string> texts;
  for (const LogEvent& event : log->events) texts.push_back(event.text);
  EXPECT_THAT(texts,
              ::testing::ElementsAre("mode 3", "disarmed", "armed", "mode 5", "Takeoff detected"));

  const auto trajectory = read_log_trajectory(*log, {});
  ASSERT_TRUE(trajectory.ok()) << trajectory.error().message;
  ASSERT_EQ(trajectory->poses.size(), 99U);
  const LogPose& pose = trajectory->poses[10];
  EXPECT_EQ(pose.t_ns, 2'105'000'000);
  // 10 m on the sphere of 6371000 m that PX4 uses.
  EXPECT_NEAR(pose.position.x(), 47.0 + deg_from_rad(10.0 / 6371000.0), 1e-9);
  EXPECT_NEAR(pose.position.z(), 500.0, 1e-4);
  EXPECT_LT(
      rotation_angle_rad(pose.R_ned_body,
                         Eigen::Quaterniond(Eigen::AngleAxisd(0.105, Eigen::Vector3d::UnitX()))),
      1e-6);
}

TEST(Ulog, TakesTheTimesOfSamples) {
  Bytes bytes = definitions();
  append(bytes,
         ulog_text('F',
                   "sensor_gps:uint64_t timestamp;uint64_t timestamp_sample;double latitude_deg;"
                   "double longitude_deg;double altitude_msl_m;uint8_t fix_type;"));
  append(bytes, ulog_subscription(0, 5, "sensor_gps"));
  for (int i = 0; i < 20; ++i) {
    const auto time_us = static_cast<std::uint64_t>(2'000'000 + 100'000 * i);
    append(bytes, attitude_message(time_us, 0.0));
    Bytes data;
    put(data, time_us);
    // Where it cannot be right, the time of the message is taken.
    put(data, i == 10 ? std::uint64_t{0} : i == 11 ? time_us + 1 : time_us - 150'000);
    for (const double value : {47.0 + 1e-5 * i, 8.0, 500.0}) put(data, value);
    data.push_back(3);
    append(bytes, ulog_data(5, data));
  }
  const overfly::testing::TemporaryFolder folder;
  const auto log = open_ulog(folder, bytes);
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->streams[4].first_ns, 1'850'000'000);
  const auto trajectory = read_log_trajectory(*log, {});
  ASSERT_TRUE(trajectory.ok()) << trajectory.error().message;
  ASSERT_GT(trajectory->poses.size(), 9U);
  for (const LogPose& pose : trajectory->poses) {
    const std::int64_t i = std::llround((pose.position.x() - 47.0) * 1e5);
    const std::int64_t t_ns = 2'000'000'000 + 100'000'000 * i;
    EXPECT_EQ(pose.t_ns, i == 10 || i == 11 ? t_ns : t_ns - 150'000'000) << i;
  }
}

TEST(Ulog, LeavesOutEstimatesThatPx4MarksAsInvalid) {
  Bytes bytes = definitions();
  append(bytes,
         ulog_text('F',
                   "vehicle_global_position:uint64_t timestamp;double lat;double lon;float alt;"
                   "bool lat_lon_valid;bool alt_valid;"));
  append(bytes, ulog_subscription(0, 5, "vehicle_global_position"));
  for (int i = 0; i < 20; ++i) {
    const auto time_us = static_cast<std::uint64_t>(2'000'000 + 100'000 * i);
    append(bytes, attitude_message(time_us, 0.0));
    Bytes data;
    put(data, time_us);
    for (const double value : {47.0, 8.0}) put(data, value);
    put(data, 500.0F);
    data.push_back(i < 3 ? 0 : 1);
    data.push_back(i < 5 ? 0 : 1);
    append(bytes, ulog_data(5, data));
  }
  const overfly::testing::TemporaryFolder folder;
  const auto log = open_ulog(folder, bytes);
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->streams[4].positions, 15U);
  EXPECT_EQ(log->streams[4].invalid, 5U);
}

TEST(Ulog, ReadsTheTruthOfASimulationWhoseFlagsAreNotSet) {
  const char* const truth = "vehicle_local_position_groundtruth";
  Bytes bytes = definitions();
  append(bytes,
         ulog_text('F',
                   std::string(truth) +
                       ":uint64_t timestamp;double ref_lat;double ref_lon;float x;float y;float z;"
                       "float ref_alt;bool xy_valid;bool z_valid;bool xy_global;bool z_global;"));
  append(bytes, ulog_subscription(0, 5, truth));
  for (int i = 0; i < 20; ++i) {
    const auto time_us = static_cast<std::uint64_t>(2'000'000 + 100'000 * i);
    append(bytes, attitude_message(time_us, 0.0));
    Bytes data;
    put(data, time_us);
    for (const double value : {47.0, 8.0}) put(data, value);
    for (const float value : {1.0F * i, 10.0F, -100.0F, 400.0F}) put(data, value);
    data.insert(data.end(), 4, 0);
    append(bytes, ulog_data(5, data));
  }
  const overfly::testing::TemporaryFolder folder;
  const auto log = open_ulog(folder, bytes);
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->streams[4].positions, 20U);
  EXPECT_TRUE(log->streams[4].georeferenced);
  ASSERT_TRUE(log->truth);
  EXPECT_EQ(log->truth->position, 4U);
}

TEST(Ulog, KeepsLocalPositionsWithoutAnOriginLocal) {
  Bytes bytes = definitions();
  for (int i = 0; i < 20; ++i) {
    const auto time_us = static_cast<std::uint64_t>(2'000'000 + 10'000 * i);
    append(bytes, attitude_message(time_us, 0.0));
    append(bytes, local_position(time_us, static_cast<float>(i), false));
  }
  const overfly::testing::TemporaryFolder folder;
  const auto log = open_ulog(folder, bytes);
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_THAT(log->truth->reason, HasSubstr("origin that the log does not state"));
  const auto trajectory = read_log_trajectory(*log, {});
  ASSERT_TRUE(trajectory.ok()) << trajectory.error().message;
  EXPECT_FALSE(trajectory->georeferenced);
  EXPECT_THAT(write_log_csv(folder.path() / "a.csv", *trajectory).error().message,
              HasSubstr("only a .tum file can hold them"));
  EXPECT_TRUE(write_log_tum(folder.path() / "a.tum", *trajectory).ok());
}

TEST(Ulog, ContinuesAtAppendedDataAfterACutMessage) {
  Bytes start = definitions(1, 0);
  append(start, flight(20));
  Bytes cut = attitude_message(9'000'000, 0.0);
  cut.resize(cut.size() - 9);
  append(start, cut);
  Bytes bytes = definitions(1, start.size());
  bytes.insert(bytes.end(), start.begin() + static_cast<std::ptrdiff_t>(bytes.size()), start.end());
  append(bytes, attitude_message(3'000'000, 0.0));
  const overfly::testing::TemporaryFolder folder;
  const auto log = open_ulog(folder, bytes);
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->streams[0].messages, 21U);
  EXPECT_EQ(log->streams[0].last_ns, 3 * kNsPerS);
  EXPECT_THAT(log->warnings, Contains(HasSubstr("1 messages are cut off")));
}

TEST(Ulog, RefusesAFileThatNeedsANewerReader) {
  const overfly::testing::TemporaryFolder folder;
  const auto log = open_ulog(folder, definitions(2, 0));
  ASSERT_FALSE(log.ok());
  EXPECT_EQ(log.error().code, ErrorCode::kUnsupported);
  EXPECT_THAT(log.error().message, HasSubstr("incompat_flags[0] = 2"));
}

/// Damage can look like any kind of message.
TEST(Ulog, IgnoresFlagsThatAreNotInTheFirstMessage) {
  for (const bool after_damage : {false, true}) {
    Bytes bytes = definitions();
    append(bytes, flight(20));
    if (after_damage) append(bytes, Bytes(50, 0xEE));
    append(bytes, flag_bits(0xFF, 0));
    append(bytes, flag_bits(1, bytes.size() + 500));  // in the middle of a message
    append(bytes, attitude_message(3'000'000, 0.0));
    for (int i = 1; i < 20; ++i) {
      append(bytes, attitude_message(static_cast<std::uint64_t>(3'000'000 + 10'000 * i), 0.0));
    }
    const overfly::testing::TemporaryFolder folder;
    const auto log = open_ulog(folder, bytes);
    ASSERT_TRUE(log.ok()) << log.error().message;
    EXPECT_EQ(log->streams[0].messages, 40U);
    EXPECT_THAT(log->warnings,
                Contains(HasSubstr("2 messages with flags are not the first one of the file")));
    EXPECT_THAT(log->warnings, ::testing::Not(Contains(HasSubstr("are cut off"))));
  }
}

TEST(Ulog, IgnoresStatesThatNoVehicleHas) {
  Bytes bytes = ulog_header();
  append(bytes,
         ulog_text('F', "vehicle_status:uint64_t timestamp;double nav_state;double arming_state;"));
  append(bytes, ulog_subscription(0, 1, "vehicle_status"));
  std::uint64_t time_us = 2'000'000;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double state : {3.0, 1e300, kNan, kNan, -1.0, 256.0, 3.0, 2.0}) {
    Bytes data;
    put(data, time_us += 10'000);
    put(data, state);
    put(data, state);
    append(bytes, ulog_data(1, data));
  }
  const overfly::testing::TemporaryFolder folder;
  const auto log = open_ulog(folder, bytes);
  ASSERT_TRUE(log.ok()) << log.error().message;
  std::vector<std::string> texts;
  for (const LogEvent& event : log->events) texts.push_back(event.text);
  EXPECT_THAT(texts, ::testing::ElementsAre("mode 3", "disarmed", "mode 2", "armed"));
}

TEST(Ulog, LeavesOutValuesThatAreNotNumbers) {
  Bytes bytes = definitions();
  append(bytes, attitude_message(2'000'000, std::numeric_limits<double>::quiet_NaN()));
  append(bytes, attitude_message(2'010'000, 0.0));
  append(bytes, local_position(2'010'000, std::numeric_limits<float>::infinity()));
  append(bytes, local_position(2'020'000, 1.0F));
  const overfly::testing::TemporaryFolder folder;
  const auto log = open_ulog(folder, bytes);
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->streams[0].attitudes, 1U);
  EXPECT_EQ(log->streams[0].invalid, 1U);
  EXPECT_EQ(log->streams[1].positions, 1U);
  EXPECT_EQ(log->streams[1].invalid, 1U);
}

TEST(Ulog, FindsTheNextMessageAfterDamage) {
  Bytes bytes = definitions();
  append(bytes, flight(20));
  append(bytes, Bytes(50, 0xEE));
  append(bytes, attitude_message(3'000'000, 0.0));
  append(bytes, attitude_message(3'010'000, 0.0));
  const overfly::testing::TemporaryFolder folder;
  const auto log = open_ulog(folder, bytes);
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->streams[0].messages, 22U);
  EXPECT_THAT(log->warnings, Contains(HasSubstr("in 1 place belong to no message")));
}

}  // namespace
}  // namespace overfly::flight::logs
