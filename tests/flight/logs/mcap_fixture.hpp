// MCAP files made by hand, for tests.
#pragma once

#include <gtest/gtest.h>
#include <libdeflate.h>
#include <lz4frame.h>
#include <zstd.h>

#include <cstdint>
#include <string>

#include "core/motion/pose.hpp"
#include "core/time.hpp"
#include "flight/logs/truth/log_trajectory.hpp"
#include "tests/flight/logs/ros_bytes.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight::logs {

inline constexpr std::int64_t kStartNs = 1'700'000'000'000'000'000;

inline std::uint32_t crc_of(const testing::Bytes& bytes) {
  return libdeflate_crc32(0, bytes.data(), bytes.size());
}

inline testing::Bytes lz4_of(const testing::Bytes& raw) {
  testing::Bytes stored(LZ4F_compressFrameBound(raw.size(), nullptr));
  stored.resize(LZ4F_compressFrame(stored.data(), stored.size(), raw.data(), raw.size(), nullptr));
  return stored;
}

inline testing::Bytes zstd_of(const testing::Bytes& raw) {
  testing::Bytes stored(ZSTD_compressBound(raw.size()));
  stored.resize(ZSTD_compress(stored.data(), stored.size(), raw.data(), raw.size(), 1));
  return stored;
}

inline const char* encoding_of(testing::Wire wire) {
  return wire == testing::Wire::kRos1 ? "ros1" : "cdr";
}

inline std::string type_of(testing::Wire wire,
                           const std::string& package,
                           const std::string& name) {
  return package + (wire == testing::Wire::kRos1 ? "/" : "/msg/") + name;
}

inline testing::Bytes topic_declarations(testing::Wire wire) {
  testing::Bytes bytes = testing::mcap_schema(1, type_of(wire, "geometry_msgs", "PoseStamped"));
  testing::append(bytes, testing::mcap_schema(2, type_of(wire, "nav_msgs", "Odometry")));
  testing::append(bytes, testing::mcap_schema(3, type_of(wire, "sensor_msgs", "NavSatFix")));
  testing::append(bytes, testing::mcap_schema(4, type_of(wire, "sensor_msgs", "Imu")));
  testing::append(bytes, testing::mcap_schema(5, type_of(wire, "sensor_msgs", "Image")));
  testing::append(bytes, testing::mcap_schema(6, type_of(wire, "std_msgs", "String")));
  testing::append(bytes, testing::mcap_channel(1, 1, "/truth/pose", encoding_of(wire)));
  testing::append(bytes, testing::mcap_channel(2, 2, "/odom", encoding_of(wire)));
  testing::append(bytes, testing::mcap_channel(3, 3, "/gps/fix", encoding_of(wire)));
  testing::append(bytes, testing::mcap_channel(4, 4, "/imu/data", encoding_of(wire)));
  testing::append(bytes, testing::mcap_channel(5, 5, "/camera/image_raw", encoding_of(wire)));
  testing::append(bytes, testing::mcap_channel(6, 6, "/chatter", encoding_of(wire)));
  return bytes;
}

/// 100 ms of a flight: to the east and upwards.
inline testing::Bytes flight_step(testing::Wire wire, int i) {
  const std::int64_t t_ns = kStartNs + i * kNsPerS / 10;
  const auto log_ns = static_cast<std::uint64_t>(t_ns + 1'000'000);
  const Eigen::Vector3d p_enu(10.0 * i, 0.0, 100.0 + i);
  const Eigen::Quaterniond level = Eigen::Quaterniond::Identity();
  testing::Bytes bytes =
      testing::mcap_message(1, log_ns, testing::pose_stamped(wire, t_ns, p_enu, level));
  testing::append(bytes,
                  testing::mcap_message(2, log_ns, testing::odometry(wire, t_ns, p_enu, level)));
  testing::append(bytes,
                  testing::mcap_message(
                      3, log_ns, testing::nav_sat_fix(wire, t_ns, 47.0, 8.0 + 1e-4 * i, 500.0)));
  testing::append(bytes, testing::mcap_message(4, log_ns, testing::imu_message(wire, t_ns, level)));
  testing::append(bytes, testing::mcap_message(5, log_ns, testing::image_message(wire, t_ns, 300)));
  testing::append(bytes, testing::mcap_message(6, log_ns, {1, 2, 3}));
  return bytes;
}

inline testing::Bytes flight_records(testing::Wire wire, int count = 20) {
  testing::Bytes bytes = topic_declarations(wire);
  for (int i = 0; i < count; ++i) testing::append(bytes, flight_step(wire, i));
  return bytes;
}

inline testing::Bytes whole_file(const testing::Bytes& records) {
  testing::Bytes bytes = testing::mcap_start("ros2");
  testing::append(bytes, records);
  testing::append(bytes, testing::mcap_end());
  return bytes;
}

class Mcap : public ::testing::Test {
 protected:
  Result<OpenedLog> open_bytes(const testing::Bytes& bytes) {
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

}  // namespace overfly::flight::logs
