#include "middleware/ros1/messages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ros/serialization.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace overfly::ros1 {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

PinholeCamera camera() { return {64, 48, 35.5, 35.25, 31.5, 23.5}; }

TEST(Ros1Messages, CallAPinholeAPlumbBobWithoutDistortion) {
  const CameraInfoMessage info = message_from(camera(), {});
  EXPECT_EQ(info.distortion_model, "plumb_bob");
  EXPECT_THAT(info.D, ElementsAre(0, 0, 0, 0, 0));
  EXPECT_THAT(info.K, ElementsAre(35.5, 0, 31.5, 0, 35.25, 23.5, 0, 0, 1));
  EXPECT_THAT(info.P, ElementsAre(35.5, 0, 31.5, 0, 0, 35.25, 23.5, 0, 0, 0, 1, 0));
  EXPECT_THAT(info.R, ElementsAre(1, 0, 0, 0, 1, 0, 0, 0, 1));
  EXPECT_EQ(info.width, 64U);
  EXPECT_EQ(info.height, 48U);
}

TEST(Ros1Messages, KeepTheOrderOfTheCoefficients) {
  const auto radtan = message_from(camera(), {DistortionModel::kRadtan, {1, 2, 3, 4, 5}});
  EXPECT_EQ(radtan.distortion_model, "plumb_bob");
  EXPECT_THAT(radtan.D, ElementsAre(1, 2, 3, 4, 5)) << "k1 k2 p1 p2 k3, as ours";
  const auto fisheye = message_from(camera(), {DistortionModel::kEquidistant, {1, 2, 3, 4}});
  EXPECT_EQ(fisheye.distortion_model, "equidistant");
  EXPECT_THAT(fisheye.D, ElementsAre(1, 2, 3, 4));
  const auto fov = message_from(camera(), {DistortionModel::kFov, {0.9}});
  EXPECT_EQ(fov.distortion_model, "fov");
  EXPECT_THAT(fov.D, ElementsAre(0.9));
}

TEST(Ros1Messages, GiveBackThePose) {
  Pose pose;
  pose.translation = {1, -2, 3};
  pose.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
  const std::optional<Pose> again = pose_from(pose_message_from(pose));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->translation, pose.translation);
  EXPECT_NEAR(rotation_angle_rad(again->rotation, pose.rotation), 0.0, 1e-12);
  const std::optional<Pose> transformed = pose_from(transform_message_from(pose));
  ASSERT_TRUE(transformed);
  EXPECT_EQ(transformed->matrix(), again->matrix());
}

TEST(Ros1Messages, RefusePosesThatAreNone) {
  PoseMessage zero;  // as a node leaves it that did not fill it in
  EXPECT_FALSE(pose_from(zero));
  PoseMessage bad = pose_message_from({});
  bad.position.y = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(pose_from(bad));
  bad = pose_message_from({});
  bad.orientation.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(pose_from(bad));
  PoseMessage rounded = pose_message_from({});
  rounded.orientation.w = 0.9999;
  ASSERT_TRUE(pose_from(rounded));
  EXPECT_DOUBLE_EQ(pose_from(rounded)->rotation.norm(), 1.0);
}

TEST(Ros1Messages, KeepTheBytesOfImages) {
  Image grey(3, 2, 1);
  grey.data = {1, 2, 3, 4, 5, 6};
  const ImageMessage mono = message_from(grey);
  EXPECT_EQ(mono.encoding, "mono8");
  EXPECT_EQ(mono.step, 3U);
  EXPECT_THAT(mono.data, ElementsAre(1, 2, 3, 4, 5, 6));
  Image colour(1, 1, 3);
  colour.data = {1, 2, 3};
  EXPECT_EQ(message_from(colour).encoding, "rgb8");
  EXPECT_EQ(message_from(colour).step, 3U);
}

TEST(Ros1Messages, MakeRgbOfEveryKnownEncoding) {
  const auto first_pixel = [](const char* encoding, std::vector<std::uint8_t> pixel) {
    ImageMessage message;
    message.width = message.height = 1;
    message.encoding = encoding;
    message.step = static_cast<std::uint32_t>(pixel.size()) + 2;  // padded rows
    message.data.assign(pixel.begin(), pixel.end());
    message.data.resize(message.step);
    return rgb_image_from(message, 64, 48).value().data;
  };
  EXPECT_THAT(first_pixel("mono8", {7}), ElementsAre(7, 7, 7));
  EXPECT_THAT(first_pixel("8UC1", {7}), ElementsAre(7, 7, 7));
  EXPECT_THAT(first_pixel("rgb8", {1, 2, 3}), ElementsAre(1, 2, 3));
  EXPECT_THAT(first_pixel("bgr8", {1, 2, 3}), ElementsAre(3, 2, 1));
  EXPECT_THAT(first_pixel("8UC3", {1, 2, 3}), ElementsAre(3, 2, 1));
  EXPECT_THAT(first_pixel("rgba8", {1, 2, 3, 4}), ElementsAre(1, 2, 3));
  EXPECT_THAT(first_pixel("bgra8", {1, 2, 3, 4}), ElementsAre(3, 2, 1));
}

/// A message that ends with an array without elements, which announces `count` of them.
template <typename Message>
std::vector<std::uint8_t> announcing(const Message& message, std::uint32_t count) {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream out(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(out, message);
  std::memcpy(bytes.data() + bytes.size() - sizeof(count), &count, sizeof(count));
  return bytes;
}

TEST(Ros1Messages, TakeNoMemoryForElementsThatAreAnnouncedAlone) {
  for (const std::uint32_t count : {1U, 1000U, 0x7FFFFFFFU, 0xFFFFFFFFU}) {
    std::vector<std::uint8_t> pixels = announcing(ImageMessage(), count);
    ros::serialization::IStream in(pixels.data(), static_cast<std::uint32_t>(pixels.size()));
    ImageMessage image;
    EXPECT_THROW(ros::serialization::deserialize(in, image),
                 ros::serialization::StreamOverrunException);
    EXPECT_EQ(image.data.capacity(), 0U) << count;
    std::vector<std::uint8_t> links = announcing(TransformsMessage(), count);
    ros::serialization::IStream of_links(links.data(), static_cast<std::uint32_t>(links.size()));
    TransformsMessage transforms;
    EXPECT_THROW(ros::serialization::deserialize(of_links, transforms),
                 ros::serialization::StreamOverrunException);
    EXPECT_EQ(transforms.transforms.capacity(), 0U) << count;
  }
}

TEST(Ros1Messages, RefuseImagesThatDoNotFit) {
  ImageMessage message;
  message.width = 4;
  message.height = 4;
  message.step = 4;
  message.encoding = "mono8";
  message.data.resize(15);
  const auto short_one = rgb_image_from(message, 64, 48);
  ASSERT_FALSE(short_one.ok());
  EXPECT_THAT(short_one.error().message, HasSubstr("15 bytes"));
  message.data.resize(16);
  EXPECT_TRUE(rgb_image_from(message, 64, 48).ok());
  message.encoding = "rgb8";
  EXPECT_FALSE(rgb_image_from(message, 64, 48).ok()) << "a row is shorter than its pixels";
  message.encoding = "mono8";
  message.width = 0xFFFFFFFF;
  message.height = 0xFFFFFFFF;
  EXPECT_FALSE(rgb_image_from(message, 64, 48).ok());
  message.width = 0;
  EXPECT_FALSE(rgb_image_from(message, 64, 48).ok());
}

}  // namespace
}  // namespace overfly::ros1
