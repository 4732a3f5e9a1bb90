#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libdeflate.h>
#include <lz4frame.h>
#include <zstd.h>

#include <cmath>
#include <limits>

#include "core/motion/pose.hpp"
#include "core/time.hpp"
#include "flight/logs/log_trajectory.hpp"
#include "tests/flight/logs/ros_bytes.hpp"
#include "tests/support/support.hpp"

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
using testing::mcap_schema;
using testing::mcap_start;
using ::testing::Not;
using testing::put;
using testing::Wire;

constexpr std::int64_t kStartNs = 1'700'000'000'000'000'000;

std::uint32_t crc_of(const Bytes& bytes) { return libdeflate_crc32(0, bytes.data(), bytes.size()); }

Bytes lz4_of(const Bytes& raw) {
  Bytes stored(LZ4F_compressFrameBound(raw.size(), nullptr));
  stored.resize(LZ4F_compressFrame(stored.data(), stored.size(), raw.data(), raw.size(), nullptr));
  return stored;
}

Bytes zstd_of(const Bytes& raw) {
  Bytes stored(ZSTD_compressBound(raw.size()));
  stored.resize(ZSTD_compress(stored.data(), stored.size(), raw.data(), raw.size(), 1));
  return stored;
}

const char* encoding_of(Wire wire) { return wire == Wire::kRos1 ? "ros1" : "cdr"; }

std::string type_of(Wire wire, const std::string& package, const std::string& name) {
  return package + (wire == Wire::kRos1 ? "/" : "/msg/") + name;
}

Bytes topic_declarations(Wire wire) {
  Bytes bytes = mcap_schema(1, type_of(wire, "geometry_msgs", "PoseStamped"));
  append(bytes, mcap_schema(2, type_of(wire, "nav_msgs", "Odometry")));
  append(bytes, mcap_schema(3, type_of(wire, "sensor_msgs", "NavSatFix")));
  append(bytes, mcap_schema(4, type_of(wire, "sensor_msgs", "Imu")));
  append(bytes, mcap_schema(5, type_of(wire, "sensor_msgs", "Image")));
  append(bytes, mcap_schema(6, type_of(wire, "std_msgs", "String")));
  append(bytes, mcap_channel(1, 1, "/truth/pose", encoding_of(wire)));
  append(bytes, mcap_channel(2, 2, "/odom", encoding_of(wire)));
  append(bytes, mcap_channel(3, 3, "/gps/fix", encoding_of(wire)));
  append(bytes, mcap_channel(4, 4, "/imu/data", encoding_of(wire)));
  append(bytes, mcap_channel(5, 5, "/camera/image_raw", encoding_of(wire)));
  append(bytes, mcap_channel(6, 6, "/chatter", encoding_of(wire)));
  return bytes;
}

/// 100 ms of a flight: to the east and upwards.
Bytes flight_step(Wire wire, int i) {
  const std::int64_t t_ns = kStartNs + i * kNsPerS / 10;
  const auto log_ns = static_cast<std::uint64_t>(t_ns + 1'000'000);
  const Eigen::Vector3d p_enu(10.0 * i, 0.0, 100.0 + i);
  const Eigen::Quaterniond level = Eigen::Quaterniond::Identity();
  Bytes bytes = mcap_message(1, log_ns, testing::pose_stamped(wire, t_ns, p_enu, level));
  append(bytes, mcap_message(2, log_ns, testing::odometry(wire, t_ns, p_enu, level)));
  append(bytes,
         mcap_message(3, log_ns, testing::nav_sat_fix(wire, t_ns, 47.0, 8.0 + 1e-4 * i, 500.0)));
  append(bytes, mcap_message(4, log_ns, testing::imu_message(wire, t_ns, level)));
  append(bytes, mcap_message(5, log_ns, testing::image_message(wire, t_ns, 300)));
  append(bytes, mcap_message(6, log_ns, {1, 2, 3}));
  return bytes;
}

Bytes flight_records(Wire wire, int count = 20) {
  Bytes bytes = topic_declarations(wire);
  for (int i = 0; i < count; ++i) append(bytes, flight_step(wire, i));
  return bytes;
}

Bytes whole_file(const Bytes& records) {
  Bytes bytes = mcap_start("ros2");
  append(bytes, records);
  append(bytes, mcap_end());
  return bytes;
}

class Mcap : public ::testing::Test {
 protected:
  Result<OpenedLog> open_bytes(const Bytes& bytes) {
    testing::write_bytes(folder_.path() / "flight.mcap", bytes);
    return open_log(folder_.path() / "flight.mcap");
  }
  /// @pre a stream of that name
  static const StreamInfo& stream_named(const OpenedLog& log, const std::string& name) {
    for (const StreamInfo& stream : log.streams) {
      if (stream.description.name == name) return stream;
    }
    ADD_FAILURE() << "no stream " << name;
    return log.streams.front();
  }
  static LogPose first_pose_of(const OpenedLog& log, const std::string& source) {
    const auto trajectory = read_log_trajectory(log, {source, {}, {}});
    EXPECT_TRUE(trajectory.ok()) << trajectory.error().message;
    return trajectory.ok() ? trajectory->poses.front() : LogPose{};
  }

  overfly::testing::TemporaryFolder folder_;
};

class McapWires : public Mcap, public ::testing::WithParamInterface<Wire> {};

TEST_P(McapWires, ReadsAFlight) {
  const auto log = open_bytes(whole_file(flight_records(GetParam())));
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->format, LogFormat::kMcap);
  EXPECT_THAT(log->warnings, ::testing::IsEmpty());
  ASSERT_EQ(log->streams.size(), 6U);
  for (const StreamInfo& stream : log->streams) {
    EXPECT_EQ(stream.messages, 20U) << stream.description.name;
    EXPECT_NEAR(stream.rate_hz, 10.0, 1e-9) << stream.description.name;
  }
  const StreamInfo& pose = stream_named(*log, "/truth/pose");
  EXPECT_EQ(pose.description.origin, SourceOrigin::kSimulation);
  EXPECT_EQ(pose.first_ns, kStartNs);
  EXPECT_NEAR(pose.reach_m, 190.0, 1e-9);
  EXPECT_EQ(pose.highest_m, 119.0);
  const StreamInfo& fix = stream_named(*log, "/gps/fix");
  EXPECT_EQ(fix.description.origin, SourceOrigin::kGps);
  EXPECT_EQ(fix.description.height, HeightDatum::kEllipsoid);
  EXPECT_TRUE(stream_named(*log, "/imu/data").description.imu);
  EXPECT_EQ(stream_named(*log, "/chatter").first_ns, kStartNs + 1'000'000);
  EXPECT_EQ(log->truth->position, 2U);  // the georeferenced one
  EXPECT_THAT(log->truth->reason, HasSubstr("all other positions count from an origin"));

  const auto trajectory = read_log_trajectory(*log, {"/truth/pose", {}, {}});
  ASSERT_TRUE(trajectory.ok()) << trajectory.error().message;
  ASSERT_EQ(trajectory->poses.size(), 20U);
  const LogPose& last = trajectory->poses.back();
  EXPECT_EQ(last.t_ns, kStartNs + 19 * kNsPerS / 10);
  EXPECT_EQ(last.position, Eigen::Vector3d(0.0, 190.0, -119.0));
}

INSTANTIATE_TEST_SUITE_P(AllEncodings,
                         McapWires,
                         ::testing::Values(Wire::kRos1, Wire::kCdrLittle, Wire::kCdrBig));

/// REP-103: world east-north-up, body forward-left-up. The expected attitudes are known by how an
/// aircraft stands, not by a chain of rotations.
TEST_F(Mcap, ConvertsFramesSignBySign) {
  using Axis = Eigen::AngleAxisd;
  struct Case {
    const char* what;
    Eigen::Quaterniond R_enu_flu;
    RollPitchYaw expected;
  };
  const double half = EIGEN_PI / 2.0;
  const Case cases[] = {
      {"nose to the east", Eigen::Quaterniond::Identity(), {0.0, 0.0, half}},
      {"nose to the north", Eigen::Quaterniond(Axis(half, Eigen::Vector3d::UnitZ())), {0, 0, 0}},
      {"nose to the west",
       Eigen::Quaterniond(Axis(2.0 * half, Eigen::Vector3d::UnitZ())),
       {0.0, 0.0, -half}},
      {"right wing down by 0.3 (left goes up)",
       Eigen::Quaterniond(Axis(0.3, Eigen::Vector3d::UnitX())),
       {0.3, 0.0, half}},
      {"nose up by 0.2 (about the left axis: down)",
       Eigen::Quaterniond(Axis(-0.2, Eigen::Vector3d::UnitY())),
       {0.0, 0.2, half}},
  };
  for (const Case& expected : cases) {
    Bytes records = mcap_schema(1, "geometry_msgs/msg/PoseStamped");
    append(records, mcap_channel(1, 1, "/pose", "cdr"));
    append(records,
           mcap_message(1,
                        0,
                        testing::pose_stamped(
                            Wire::kCdrLittle, kStartNs, {3.0, 5.0, 7.0}, expected.R_enu_flu)));
    const auto log = open_bytes(whole_file(records));
    ASSERT_TRUE(log.ok()) << log.error().message;
    const LogPose pose = first_pose_of(*log, "/pose");
    EXPECT_EQ(pose.position, Eigen::Vector3d(5.0, 3.0, -7.0));
    EXPECT_LT(rotation_angle_rad(
                  pose.R_ned_body,
                  Eigen::AngleAxisd(expected.expected.yaw_rad, Eigen::Vector3d::UnitZ()) *
                      Eigen::AngleAxisd(expected.expected.pitch_rad, Eigen::Vector3d::UnitY()) *
                      Eigen::AngleAxisd(expected.expected.roll_rad, Eigen::Vector3d::UnitX())),
              1e-6)
        << expected.what;
  }
}

TEST_F(Mcap, UnderstandsTheNamesOfNedAndFrdFrames) {
  const Eigen::Quaterniond R_ned_frd(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX()));
  Bytes records = mcap_schema(1, "nav_msgs/msg/Odometry");
  append(records, mcap_channel(1, 1, "/odom", "cdr"));
  append(records,
         mcap_message(1,
                      0,
                      testing::odometry(Wire::kCdrLittle,
                                        kStartNs,
                                        {3.0, 5.0, 7.0},
                                        R_ned_frd,
                                        "odom_ned",
                                        "base_link_frd")));
  const auto log = open_bytes(whole_file(records));
  ASSERT_TRUE(log.ok()) << log.error().message;
  const LogPose pose = first_pose_of(*log, "/odom");
  EXPECT_EQ(pose.position, Eigen::Vector3d(3.0, 5.0, 7.0));
  EXPECT_LT(rotation_angle_rad(pose.R_ned_body, R_ned_frd), 1e-6);
}

TEST_F(Mcap, ReadsCompressedChunks) {
  const Bytes raw = flight_records(Wire::kCdrLittle);
  for (const auto& [name, stored] :
       {std::pair{"", raw}, std::pair{"lz4", lz4_of(raw)}, std::pair{"zstd", zstd_of(raw)}}) {
    const auto log = open_bytes(whole_file(mcap_chunk(stored, raw.size(), crc_of(raw), name)));
    ASSERT_TRUE(log.ok()) << log.error().message;
    EXPECT_THAT(log->warnings, ::testing::IsEmpty()) << name;
    EXPECT_EQ(stream_named(*log, "/odom").positions, 20U) << name;
  }
}

/// Written by @mcap/core 2.2 with the serialisers of @foxglove/rosmsg{,2}-serialization: ten steps
/// of 100 ms, to the east at 15 m/s, nose to the north.
TEST_F(Mcap, ReadsFilesOfAnotherWriter) {
  for (const char* name : {"mcap_ros1_lz4", "mcap_ros2_zstd"}) {
    const auto file =
        overfly::testing::source_file(std::string("tests/fuzz/corpus/flight_log/") + name);
    const auto log = open_log(file);
    ASSERT_TRUE(log.ok()) << log.error().message;
    EXPECT_EQ(log->format, LogFormat::kMcap);
    EXPECT_THAT(log->warnings, ::testing::Each(HasSubstr("stays on the ground")));
    ASSERT_EQ(log->streams.size(), 5U);
    for (const StreamInfo& stream : log->streams) {
      EXPECT_EQ(stream.messages, 10U) << stream.description.name;
      EXPECT_EQ(stream.first_ns, kStartNs) << stream.description.name;
    }
    EXPECT_EQ(stream_named(*log, "/imu").attitudes, 10U);
    const auto odometry = read_log_trajectory(*log, {"/odom", {}, {}});
    ASSERT_TRUE(odometry.ok()) << odometry.error().message;
    ASSERT_EQ(odometry->poses.size(), 10U);
    const LogPose& last = odometry->poses.back();
    EXPECT_EQ(last.t_ns, kStartNs + 900'000'000);
    EXPECT_EQ(last.position, Eigen::Vector3d(2.0, 13.5, -39.0));
    EXPECT_LT(rotation_angle_rad(last.R_ned_body, Eigen::Quaterniond::Identity()), 1e-6);
    const auto fix = read_log_trajectory(*log, {"/fix", {}, {}});
    ASSERT_TRUE(fix.ok()) << fix.error().message;
    EXPECT_LT((fix->poses.back().position - Eigen::Vector3d(47.00009, 8.0, 512.5)).norm(), 1e-12);
  }
}

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

TEST_F(Mcap, WritesHeightsAboveTheEllipsoidAsSuch) {
  const auto log = open_bytes(whole_file(flight_records(Wire::kCdrLittle)));
  ASSERT_TRUE(log.ok()) << log.error().message;
  const auto trajectory = read_log_trajectory(*log, {});
  ASSERT_TRUE(trajectory.ok()) << trajectory.error().message;
  const std::filesystem::path csv = folder_.path() / "a.csv";
  ASSERT_TRUE(write_log_csv(csv, *trajectory).ok());
  EXPECT_THAT(overfly::testing::read_text(csv),
              HasSubstr("t_s,lat_deg,lon_deg,alt_ellipsoid_m,roll_deg,pitch_deg,yaw_deg\n"
                        "1700000000.000000000,47,8,500,"));
  EXPECT_THAT(write_log_csv(csv, *trajectory, 48.0).error().message,
              HasSubstr("are above the ellipsoid already"));
  ASSERT_TRUE(write_log_tum(folder_.path() / "a.tum", *trajectory).ok());
  EXPECT_THAT(overfly::testing::read_text(folder_.path() / "a.tum"),
              HasSubstr("# origin_alt_ellipsoid_m 500\n"));
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

TEST_F(Mcap, ReadsLargeMessagesOutsideOfChunks) {
  Bytes records = topic_declarations(Wire::kCdrLittle);
  append(records,
         mcap_message(5, 0, testing::image_message(Wire::kCdrLittle, kStartNs, 3'000'000)));
  append(records, flight_step(Wire::kCdrLittle, 1));
  const auto log = open_bytes(whole_file(records));
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(stream_named(*log, "/camera/image_raw").messages, 2U);
  EXPECT_EQ(stream_named(*log, "/camera/image_raw").first_ns, kStartNs);
  EXPECT_THAT(log->warnings, ::testing::Each(HasSubstr("stays on the ground")));
}

}  // namespace
}  // namespace overfly::flight::logs
