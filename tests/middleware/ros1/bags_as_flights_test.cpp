// Bags that ROS's own library writes, read as flight logs.
#include <gmock/gmock.h>
#include <rosbag/bag.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/NavSatFix.h>

#include "core/time.hpp"
#include "flight/logs/truth/log_trajectory.hpp"
#include "middleware/ros1/bag_writer.hpp"
#include "middleware/ros1/messages.hpp"
#include "middleware/ros1/types.hpp"
#include "tests/support/support.hpp"

namespace overfly::ros1 {
namespace {

namespace logs = flight::logs;

constexpr std::int64_t kEpochNs = 1'700'000'000'123'456'789;

TEST(BagsAsFlights, HaveThePosesOfTheWriter) {
  const overfly::testing::TemporaryFolder folder;
  const auto file = folder.path() / "a.bag";
  const auto writer = BagWriter::create(file).value();
  const Eigen::Quaterniond R_enu_flu =
      Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
  for (int i = 0; i < 50; ++i) {
    const std::int64_t t_ns = kEpochNs + i * kNsPerS / 31;
    ASSERT_TRUE(writer->add_image("/camera/image_raw", "camera", t_ns, Image(64, 48, 1, 9)).ok());
    ASSERT_TRUE(
        writer->add_pose("/camera/truth", "world", t_ns, {R_enu_flu, {1.0 * i, 2.0, 300.0}}).ok());
    ASSERT_TRUE(writer->add_transform("world", "camera", t_ns, {}).ok());
  }
  ASSERT_TRUE(writer->close().ok());

  const auto log = logs::open_log(file);
  ASSERT_TRUE(log.ok()) << log.error().message;
  ASSERT_EQ(log->streams.size(), 3U);
  for (const logs::StreamInfo& stream : log->streams) EXPECT_EQ(stream.messages, 50U);
  const auto trajectory = logs::read_log_trajectory(*log, {"/camera/truth", {}, {}});
  ASSERT_TRUE(trajectory.ok()) << trajectory.error().message;
  ASSERT_EQ(trajectory->poses.size(), 50U);
  for (int i = 0; i < 50; ++i) {
    const logs::LogPose& pose = trajectory->poses[static_cast<std::size_t>(i)];
    EXPECT_EQ(pose.t_ns, kEpochNs + i * kNsPerS / 31);
    EXPECT_EQ(pose.position, Eigen::Vector3d(2.0, 1.0 * i, -300.0));
    // x_ned, y_ned, z_ned of the body's axes are y, x, -z of those in the bag; right is minus left.
    const Eigen::Matrix3d R_ned_frd = pose.R_ned_body.toRotationMatrix();
    const Eigen::Matrix3d R = R_enu_flu.toRotationMatrix();
    Eigen::Matrix3d expected;
    expected.row(0) << R(1, 0), -R(1, 1), -R(1, 2);
    expected.row(1) << R(0, 0), -R(0, 1), -R(0, 2);
    expected.row(2) << -R(2, 0), R(2, 1), R(2, 2);
    EXPECT_LT((R_ned_frd - expected).norm(), 1e-6);
  }
}

TEST(BagsAsFlights, AreReadWithEveryCompression) {
  for (const rosbag::CompressionType compression :
       {rosbag::compression::Uncompressed, rosbag::compression::BZ2, rosbag::compression::LZ4}) {
    const overfly::testing::TemporaryFolder folder;
    const auto file = folder.path() / "a.bag";
    rosbag::Bag bag(file.string(), rosbag::bagmode::Write);
    bag.setCompression(compression);
    bag.setChunkThreshold(4096);
    for (int i = 0; i < 200; ++i) {
      const ros::Time time = time_from_ns(kEpochNs + i * kNsPerS / 10);
      OdometryMessage odometry;
      odometry.header.stamp = time;
      odometry.header.frame_id = "odom";
      odometry.child_frame_id = "base_link";
      odometry.pose.pose.position.x = i;
      odometry.pose.pose.orientation.w = 1.0;
      bag.write("/odom", time, odometry);
      sensor_msgs::NavSatFix_<MessageAllocator> fix;
      fix.header.stamp = time;
      fix.status.status = i < 10 ? -1 : 0;
      fix.latitude = 47.0;
      fix.longitude = 8.0 + 1e-5 * i;
      fix.altitude = 500.0;
      bag.write("/fix", time, fix);
      sensor_msgs::Imu_<MessageAllocator> imu;
      imu.header.stamp = time;
      imu.orientation.w = 1.0;
      imu.orientation_covariance[0] = i < 20 ? -1.0 : 0.1;
      bag.write("/imu", time, imu);
    }
    bag.close();
    const auto log = logs::open_log(file);
    ASSERT_TRUE(log.ok()) << log.error().message;
    EXPECT_THAT(log->warnings, ::testing::IsEmpty());
    ASSERT_EQ(log->streams.size(), 3U);
    EXPECT_EQ(log->streams[0].positions, 200U);
    EXPECT_NEAR(log->streams[0].reach_m, 199.0, 1e-9);
    EXPECT_EQ(log->streams[1].positions, 190U);
    EXPECT_EQ(log->streams[1].invalid, 10U);
    EXPECT_EQ(log->streams[2].attitudes, 180U);
  }
}

}  // namespace
}  // namespace overfly::ros1
