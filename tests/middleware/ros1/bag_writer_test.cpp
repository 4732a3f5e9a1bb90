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
