// Flights in MCAP files of ROS 1 and ROS 2.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/flight/logs/mcap_fixture.hpp"

namespace overfly::flight::logs {
namespace {

using testing::append;
using testing::Bytes;
using ::testing::HasSubstr;
using testing::mcap_channel;
using testing::mcap_chunk;
using testing::mcap_message;
using testing::mcap_schema;
using testing::Wire;

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

/// "ned" and "frd" at the end of another word say nothing about axes.
TEST_F(Mcap, ReadsFramesOfOtherNamesByTheirStandard) {
  const auto pose_in = [&](std::string_view world, std::string_view body) {
    const Eigen::Quaterniond level = Eigen::Quaterniond::Identity();
    Bytes records = mcap_schema(1, "nav_msgs/msg/Odometry");
    append(records, mcap_channel(1, 1, "/odom", "cdr"));
    append(records,
           mcap_message(
               1,
               0,
               testing::odometry(Wire::kCdrLittle, kStartNs, {3.0, 5.0, 7.0}, level, world, body)));
    const auto log = open_bytes(whole_file(records));
    EXPECT_TRUE(log.ok());
    return first_pose_of(*log, "/odom");
  };
  const LogPose standard = pose_in("map", "base_link");
  EXPECT_EQ(standard.position, Eigen::Vector3d(5.0, 3.0, -7.0));
  for (const char* const world : {"gravity_aligned", "map_aligned", "Aligned", "v2ned"}) {
    const LogPose pose = pose_in(world, "wharfrd");
    EXPECT_EQ(pose.position, standard.position) << world;
    EXPECT_LT(rotation_angle_rad(pose.R_ned_body, standard.R_ned_body), 1e-6) << world;
  }
  for (const char* const world : {"ned", "map_ned", "a/ned", "map-ned"}) {
    const LogPose pose = pose_in(world, "a/frd");
    EXPECT_EQ(pose.position, Eigen::Vector3d(3.0, 5.0, 7.0)) << world;
    EXPECT_LT(rotation_angle_rad(pose.R_ned_body, Eigen::Quaterniond::Identity()), 1e-6) << world;
  }
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
