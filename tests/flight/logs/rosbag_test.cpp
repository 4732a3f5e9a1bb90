#include <bzlib.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lz4frame.h>

#include "core/time.hpp"
#include "flight/logs/truth/log_trajectory.hpp"
#include "tests/flight/logs/ros_bytes.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight::logs {
namespace {

using testing::append;
using testing::bag_chunk;
using testing::bag_connection;
using testing::bag_message;
using testing::bag_start;
using testing::Bytes;
using ::testing::Contains;
using ::testing::HasSubstr;
using testing::Wire;

constexpr std::int64_t kBagStartNs = 1'700'000'000'000'000'000;

Bytes bag_connections() {
  Bytes bytes = bag_connection(0, "/odom", "nav_msgs/Odometry");
  append(bytes, bag_connection(1, "/fix", "sensor_msgs/NavSatFix"));
  append(bytes, bag_connection(2, "/imu", "sensor_msgs/Imu"));
  append(bytes, bag_connection(3, "/rosout", "rosgraph_msgs/Log"));
  return bytes;
}

Bytes bag_step(int i) {
  const std::int64_t t_ns = kBagStartNs + i * kNsPerS / 10;
  const Eigen::Quaterniond north(Eigen::AngleAxisd(EIGEN_PI / 2.0, Eigen::Vector3d::UnitZ()));
  const Wire wire = Wire::kRos1;
  Bytes bytes = bag_message(0, t_ns, testing::odometry(wire, t_ns, {3.0, 10.0 * i, 50.0}, north));
  append(bytes, bag_message(1, t_ns, testing::nav_sat_fix(wire, t_ns, 47.0 + 1e-4 * i, 8, 500)));
  append(bytes, bag_message(2, t_ns, testing::imu_message(wire, t_ns, north)));
  append(bytes, bag_message(3, t_ns + 5, {1, 2, 3}));
  return bytes;
}

Bytes bag_records(int count) {
  Bytes bytes = bag_connections();
  for (int i = 0; i < count; ++i) append(bytes, bag_step(i));
  return bytes;
}

Bytes stored_as(const std::string& compression, const Bytes& raw) {
  if (compression == "none") return raw;
  if (compression == "lz4") {
    Bytes stored(LZ4F_compressFrameBound(raw.size(), nullptr));
    stored.resize(
        LZ4F_compressFrame(stored.data(), stored.size(), raw.data(), raw.size(), nullptr));
    return stored;
  }
  Bytes stored(raw.size() + raw.size() / 100 + 600);
  Bytes in = raw;
  auto size = static_cast<unsigned>(stored.size());
  EXPECT_EQ(BZ2_bzBuffToBuffCompress(reinterpret_cast<char*>(stored.data()),
                                     &size,
                                     reinterpret_cast<char*>(in.data()),
                                     static_cast<unsigned>(in.size()),
                                     1,
                                     0,
                                     0),
            BZ_OK);
  stored.resize(size);
  return stored;
}

class Rosbag : public ::testing::Test {
 protected:
  Result<OpenedLog> open_bytes(const Bytes& bytes) {
    testing::write_bytes(folder_.path() / "flight.bag", bytes);
    return open_log(folder_.path() / "flight.bag");
  }
  overfly::testing::TemporaryFolder folder_;
};

TEST_F(Rosbag, ReadsChunksOfEveryCompression) {
  const Bytes raw = bag_records(20);
  for (const std::string compression : {"none", "lz4", "bz2"}) {
    Bytes bytes = bag_start(1);
    const Bytes stored = stored_as(compression, raw);
    append(bytes, bag_chunk(compression, static_cast<std::uint32_t>(raw.size()), stored));
    // The index: its connections are those of the chunk.
    append(bytes, bag_connections());
    const auto log = open_bytes(bytes);
    ASSERT_TRUE(log.ok()) << log.error().message;
    EXPECT_EQ(log->format, LogFormat::kRosbag);
    EXPECT_THAT(log->warnings, ::testing::IsEmpty()) << compression;
    ASSERT_EQ(log->streams.size(), 4U);
    for (const StreamInfo& stream : log->streams) EXPECT_EQ(stream.messages, 20U);
    EXPECT_EQ(log->streams[3].first_ns, kBagStartNs + 5);
    EXPECT_EQ(log->truth->position, 1U);
    const auto trajectory = read_log_trajectory(*log, {"/odom", {}, {}});
    ASSERT_TRUE(trajectory.ok()) << trajectory.error().message;
    ASSERT_EQ(trajectory->poses.size(), 20U);
    EXPECT_EQ(trajectory->poses.back().t_ns, kBagStartNs + 19 * kNsPerS / 10);
    EXPECT_EQ(trajectory->poses.back().position, Eigen::Vector3d(190.0, 3.0, -50.0));
    EXPECT_LT(std::abs(trajectory->poses.back().R_ned_body.w()) - 1.0, 1e-6);
  }
}

/// A recorder that ends early leaves neither an index nor the lengths of its last chunk.
TEST_F(Rosbag, ReadsABagThatWasNotClosed) {
  const Bytes raw = bag_records(200);
  for (const std::string compression : {"none", "lz4", "bz2"}) {
    Bytes bytes = bag_start(0);
    append(bytes, bag_chunk("none", static_cast<std::uint32_t>(raw.size()), raw));
    Bytes unfinished = bag_chunk(compression, 0, {});
    Bytes stored = stored_as(compression, raw);
    // bz2 has blocks of at least 100 kB: the end of the last one may be missing, not more.
    stored.resize(compression == "bz2" ? stored.size() - 1 : stored.size() - 50);
    append(unfinished, stored);
    append(bytes, unfinished);
    const auto log = open_bytes(bytes);
    ASSERT_TRUE(log.ok()) << log.error().message;
    EXPECT_GE(log->streams[0].messages, 250U) << compression;
    EXPECT_THAT(log->warnings, Contains(HasSubstr("the recording was not closed")));
  }
}

TEST_F(Rosbag, JoinsThePublishersOfATopic) {
  Bytes bytes = bag_start(1);
  append(bytes, bag_connection(0, "/odom", "nav_msgs/Odometry"));
  append(bytes, bag_connection(1, "/odom", "nav_msgs/Odometry"));
  for (int i = 0; i < 4; ++i) {
    const std::int64_t t_ns = kBagStartNs + i * kNsPerS;
    append(bytes,
           bag_message(
               static_cast<std::uint32_t>(i % 2),
               t_ns,
               testing::odometry(Wire::kRos1, t_ns, {1, 2, 3}, Eigen::Quaterniond::Identity())));
  }
  const auto log = open_bytes(bytes);
  ASSERT_TRUE(log.ok()) << log.error().message;
  ASSERT_EQ(log->streams.size(), 1U);
  EXPECT_EQ(log->streams[0].positions, 4U);
}

TEST_F(Rosbag, ReportsWhatIsDamaged) {
  const Bytes raw = bag_records(3);
  const auto size = static_cast<std::uint32_t>(raw.size());
  const struct {
    Bytes record;
    const char* warning;
  } cases[] = {
      {bag_chunk("lz4", size, raw), "1 chunks cannot be decompressed"},
      {bag_chunk("bz2", size, raw), "1 chunks cannot be decompressed"},
      {bag_chunk("none", size + 1, raw), "1 chunks cannot be decompressed"},
      {bag_chunk("bz2", 0xFFFFFFFF, raw), "larger than 128 MiB"},
      {bag_chunk("zstd", size, raw), "in a way that is not read"},
      {bag_message(9, kBagStartNs, {}), "1 messages belong to no connection"},
      {testing::bag_record({{"op", {2}}}, {}), "1 records have wrong lengths or lack fields"},
      {testing::bag_record({{"op", {7}}}, {}), "1 records have wrong lengths or lack fields"},
  };
  for (const auto& damaged : cases) {
    Bytes bytes = bag_start(1);
    append(bytes, damaged.record);
    append(bytes, bag_chunk("none", size, raw));
    const auto log = open_bytes(bytes);
    ASSERT_TRUE(log.ok()) << log.error().message;
    EXPECT_THAT(log->warnings, Contains(HasSubstr(damaged.warning)));
    EXPECT_EQ(log->streams[0].messages, 3U) << damaged.warning;
  }
  Bytes bytes = bag_start(1);
  append(bytes, bag_chunk("none", size, raw));
  append(bytes, Bytes(100, 0xFF));
  const auto log = open_bytes(bytes);
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->streams[0].messages, 3U);
  EXPECT_THAT(log->warnings, Contains(HasSubstr("100 bytes at the end belong to no record")));
}

TEST_F(Rosbag, RefusesAnEncryptedBag) {
  const auto log = open_bytes(bag_start(1, "rosbag/AesCbcEncryptor"));
  ASSERT_FALSE(log.ok());
  EXPECT_EQ(log.error().code, ErrorCode::kUnsupported);
  EXPECT_THAT(log.error().message, HasSubstr("flight.bag: the bag is encrypted"));
}

}  // namespace
}  // namespace overfly::flight::logs
