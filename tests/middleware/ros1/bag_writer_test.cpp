#include "middleware/ros1/bag_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "middleware/ros1/types.hpp"
#include "tests/support/support.hpp"

namespace overfly::ros1 {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::int64_t kStampNs = 1'700'000'000'123'456'789;

void write_example(const std::filesystem::path& file) {
  auto writer = BagWriter::create(file).value();
  const CameraModel camera({4, 2, 3.0, 3.0, 1.5, 0.5}, {DistortionModel::kRadtan, {0.1}});
  Pose pose;
  pose.translation = {1, 2, 3};
  ASSERT_TRUE(writer->add_camera_info("/cam/camera_info", "cam", kStampNs, camera).ok());
  ASSERT_TRUE(writer->add_image("/cam/image_raw", "cam", kStampNs, Image(4, 2, 1, 9)).ok());
  ASSERT_TRUE(writer->add_pose("/cam/truth", "world", kStampNs, pose).ok());
  ASSERT_TRUE(writer->add_transform("world", "cam", kStampNs, pose).ok());
  ASSERT_TRUE(writer->close().ok());
}

TEST(Ros1BagWriter, IsReadBackByRosItself) {
  const testing::TemporaryFolder folder;
  write_example(folder.path() / "a.bag");
  rosbag::Bag bag((folder.path() / "a.bag").string());
  rosbag::View view(bag);
  ASSERT_EQ(view.size(), 4U);
  std::vector<std::string> topics;
  for (const rosbag::MessageInstance& message : view) {
    topics.push_back(message.getTopic() + " " + message.getDataType());
    EXPECT_EQ(message.getTime().toNSec(), static_cast<std::uint64_t>(kStampNs));
    if (const auto image = message.instantiate<ImageMessage>()) {
      EXPECT_EQ(image->data.size(), 8U);
      EXPECT_EQ(image->data[7], 9);
      EXPECT_EQ(image->header.frame_id, "cam");
      EXPECT_EQ(image->header.stamp, message.getTime());
    }
    if (const auto info = message.instantiate<CameraInfoMessage>()) {
      EXPECT_THAT(info->D, ElementsAre(0.1, 0, 0, 0, 0));
    }
    if (const auto pose = message.instantiate<PoseStampedMessage>()) {
      EXPECT_EQ(pose->pose.position.z, 3.0);
      EXPECT_EQ(pose->pose.orientation.w, 1.0);
      EXPECT_EQ(pose->header.frame_id, "world");
    }
  }
  EXPECT_THAT(topics,
              ::testing::UnorderedElementsAre("/cam/camera_info sensor_msgs/CameraInfo",
                                              "/cam/image_raw sensor_msgs/Image",
                                              "/cam/truth geometry_msgs/PoseStamped",
                                              "/tf tf2_msgs/TFMessage"));
}

TEST(Ros1BagWriter, SamplesOfSensorsAreStandardMessages) {
  const testing::TemporaryFolder folder;
  SensorSamples samples;
  samples.imu = {{5'000'000, {1.0, 2.0, -9.75}, {4.0, 5.0, 6.0}}};
  samples.barometer = {{2'000'000, 98765.5, 283.15}};
  GpsSample fix;
  fix.t_ns = 1'000'000;
  fix.delivered_ns = 9'000'000;
  fix.place = geodetic_from_deg(39.5, -86.0, 210.5);
  fix.velocity_ned_m_s = {20.0, -3.0, 0.5};
  fix.horizontal_accuracy_m = 2.0;
  fix.vertical_accuracy_m = 3.0;
  GpsSample none = fix;
  none.delivered_ns = 10'000'000;
  none.fix = GpsFixType::kNone;
  samples.gps = {fix, none};
  samples.airspeed = {{3'000'000, 350.5, 23.75}};
  samples.magnetometer = {{4'000'000, {20.0, -1.0, 48.0}}};
  samples.range = {{6'000'000, 55.5}};
  {
    auto writer = BagWriter::create(folder.path() / "a.bag").value();
    ASSERT_TRUE(writer->add_samples(samples, kStampNs).ok());
    ASSERT_TRUE(writer->close().ok());
  }
  rosbag::Bag bag((folder.path() / "a.bag").string());
  rosbag::View view(bag);
  std::map<std::string, std::string> topics;
  int fixes = 0;
  for (const rosbag::MessageInstance& message : view) {
    topics[message.getTopic()] = message.getDataType();
    if (const auto imu = message.instantiate<ImuMessage>()) {
      // Forward-right-down became forward-left-up.
      EXPECT_EQ(imu->angular_velocity.x, 4.0);
      EXPECT_EQ(imu->angular_velocity.y, -5.0);
      EXPECT_EQ(imu->angular_velocity.z, -6.0);
      EXPECT_EQ(imu->linear_acceleration.z, 9.75);
      EXPECT_EQ(imu->orientation_covariance[0], -1.0);
      EXPECT_EQ(imu->header.frame_id, "base_link");
    }
    if (const auto gps = message.instantiate<NavSatFixMessage>()) {
      ++fixes;
      EXPECT_EQ(gps->header.stamp.toNSec(), static_cast<std::uint64_t>(kStampNs + 1'000'000));
      const std::uint64_t delivered_ns = fixes == 1 ? 9'000'000 : 10'000'000;
      EXPECT_EQ(message.getTime().toNSec(), static_cast<std::uint64_t>(kStampNs) + delivered_ns);
      EXPECT_EQ(gps->status.status, fixes == 1 ? 0 : -1);
      EXPECT_NEAR(gps->latitude, 39.5, 1e-12);
      EXPECT_EQ(gps->altitude, 210.5);
      if (fixes == 1) {
        EXPECT_THAT(gps->position_covariance, ElementsAre(4, 0, 0, 0, 4, 0, 0, 0, 9));
      }
    }
    if (const auto velocity = message.instantiate<TwistStampedMessage>()) {
      EXPECT_EQ(velocity->twist.linear.x, -3.0);
      EXPECT_EQ(velocity->twist.linear.y, 20.0);
      EXPECT_EQ(velocity->twist.linear.z, -0.5);
      EXPECT_EQ(velocity->header.frame_id, "world") << "east, north, up";
    }
    if (const auto pressure = message.instantiate<FluidPressureMessage>()) {
      EXPECT_EQ(pressure->fluid_pressure,
                message.getTopic() == "/sensors/pressure" ? 98765.5 : 350.5);
    }
    if (const auto temperature = message.instantiate<TemperatureMessage>()) {
      EXPECT_NEAR(temperature->temperature, 10.0, 1e-9);
    }
    if (const auto field = message.instantiate<MagneticFieldMessage>()) {
      EXPECT_NEAR(field->magnetic_field.x, 20e-6, 1e-12);
      EXPECT_NEAR(field->magnetic_field.z, -48e-6, 1e-12);
    }
    if (const auto range = message.instantiate<RangeMessage>()) {
      EXPECT_EQ(range->range, 55.5F);
      EXPECT_EQ(range->header.frame_id, "range_link");
    }
  }
  const std::map<std::string, std::string> expected = {
      {"/sensors/imu", "sensor_msgs/Imu"},
      {"/sensors/pressure", "sensor_msgs/FluidPressure"},
      {"/sensors/temperature", "sensor_msgs/Temperature"},
      {"/sensors/gps/fix", "sensor_msgs/NavSatFix"},
      {"/sensors/gps/velocity", "geometry_msgs/TwistStamped"},
      {"/sensors/airspeed/differential_pressure", "sensor_msgs/FluidPressure"},
      {"/sensors/magnetic_field", "sensor_msgs/MagneticField"},
      {"/sensors/range", "sensor_msgs/Range"}};
  EXPECT_EQ(topics, expected);
  EXPECT_EQ(fixes, 2);
}

TEST(Ros1BagWriter, WritesTheSameBytesEachTime) {
  const testing::TemporaryFolder folder;
  write_example(folder.path() / "a.bag");
  write_example(folder.path() / "b.bag");
  EXPECT_EQ(testing::read_text(folder.path() / "a.bag"),
            testing::read_text(folder.path() / "b.bag"));
}

TEST(Ros1BagWriter, NamesTheFileThatItCannotWrite) {
  const auto writer = BagWriter::create("/nowhere/a.bag");
  ASSERT_FALSE(writer.ok());
  EXPECT_EQ(writer.error().code, ErrorCode::kIo);
  EXPECT_THAT(writer.error().message, HasSubstr("/nowhere/a.bag"));
}

}  // namespace
}  // namespace overfly::ros1
