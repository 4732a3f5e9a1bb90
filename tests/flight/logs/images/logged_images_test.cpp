#include "flight/logs/images/logged_images.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lz4frame.h>

#include <functional>

#include "core/time.hpp"
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
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::put_big;
using testing::Wire;
using testing::WireWriter;

constexpr std::uint32_t kPictureWidth = 40;
constexpr std::uint32_t kPictureHeight = 6;

std::uint8_t picture_pixel(int number, std::uint32_t i) {
  return static_cast<std::uint8_t>(7 * number + 3 * i);
}

Bytes picture_pixels(int number) {
  Bytes pixels(std::size_t{kPictureWidth} * kPictureHeight);
  for (std::uint32_t i = 0; i < pixels.size(); ++i) pixels[i] = picture_pixel(number, i);
  return pixels;
}

Bytes ros_picture(Wire wire,
                  std::int64_t stamp_ns,
                  int number,
                  std::string_view encoding = "mono8") {
  WireWriter message(wire);
  message.header(stamp_ns, "camera").number(kPictureHeight).number(kPictureWidth).text(encoding);
  message.number(std::uint8_t{0}).number(kPictureWidth).number(kPictureWidth * kPictureHeight);
  Bytes bytes = message.bytes();
  append(bytes, picture_pixels(number));
  return bytes;
}

Bytes lz4_stored(const Bytes& raw) {
  Bytes stored(LZ4F_compressFrameBound(raw.size(), nullptr));
  stored.resize(LZ4F_compressFrame(stored.data(), stored.size(), raw.data(), raw.size(), nullptr));
  return stored;
}

/// Overfly's image_t: seven numbers, a truth value of one byte, five numbers and the data.
Bytes own_lcm_picture(std::int64_t t_ns, int number) {
  Bytes bytes;
  put_big(bytes, std::uint64_t{0xf4937b0d814172f8});
  for (const std::int64_t value : {t_ns / 1000,
                                   t_ns,
                                   std::int64_t{0},
                                   std::int64_t{number},
                                   std::int64_t{1},
                                   std::int64_t{0},
                                   std::int64_t{0}}) {
    put_big(bytes, value);
  }
  bytes.push_back(0);
  for (const std::uint32_t value : {kPictureWidth,
                                    kPictureHeight,
                                    kPictureWidth,
                                    1497715271U,
                                    kPictureWidth * kPictureHeight}) {
    put_big(bytes, value);
  }
  append(bytes, picture_pixels(number));
  return bytes;
}

Bytes libbot_picture(std::int64_t t_us, int number) {
  Bytes bytes;
  put_big(bytes, std::uint64_t{0x14739ffe13d5f5f0});
  put_big(bytes, t_us);
  for (const std::uint32_t value : {kPictureWidth,
                                    kPictureHeight,
                                    kPictureWidth,
                                    1497715271U,
                                    kPictureWidth * kPictureHeight}) {
    put_big(bytes, value);
  }
  append(bytes, picture_pixels(number));
  put_big(bytes, std::uint32_t{0});
  return bytes;
}

class LoggedImagesTest : public ::testing::Test {
 protected:
  Result<std::unique_ptr<LoggedImages>> open_bytes(const Bytes& bytes,
                                                   const std::string& topic = "") {
    testing::write_bytes(folder_.path() / "log", bytes);
    return LoggedImages::open(folder_.path() / "log", topic, nullptr);
  }

  /// Image `i` must be the one that was made with this number.
  static void expect_picture(LoggedImages& images, std::size_t i, int number) {
    const auto picture = images.read(i);
    ASSERT_TRUE(picture.ok()) << picture.error().message;
    EXPECT_EQ(picture->encoding, "mono8");
    EXPECT_EQ(picture->width_px, static_cast<int>(kPictureWidth));
    EXPECT_EQ(picture->height_px, static_cast<int>(kPictureHeight));
    EXPECT_EQ(picture->row_bytes, kPictureWidth);
    EXPECT_EQ(Bytes(picture->data.begin(), picture->data.end()), picture_pixels(number));
  }

  overfly::testing::TemporaryFolder folder_;
};

TEST_F(LoggedImagesTest, ReadsBagsInAnyOrderAndSortsByTheHeadersStamp) {
  // Three chunks; the second image was taken before the first.
  Bytes bytes = bag_start(1);
  const std::int64_t stamps_ns[] = {2 * kNsPerS, 1 * kNsPerS, 3 * kNsPerS, 4 * kNsPerS};
  for (int i = 0; i < 4; ++i) {
    Bytes records = bag_connection(0, "/camera/image_raw", "sensor_msgs/Image");
    append(records, bag_connection(1, "/odom", "nav_msgs/Odometry"));
    append(
        records,
        bag_message(1,
                    i,
                    testing::odometry(
                        Wire::kRos1, i, Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity())));
    append(records, bag_message(0, i, ros_picture(Wire::kRos1, stamps_ns[i], i)));
    append(records, bag_message(0, i, ros_picture(Wire::kRos1, stamps_ns[i] + 7, 10 + i)));
    append(bytes,
           i % 2 == 0 ? bag_chunk("none", records.size(), records)
                      : bag_chunk("lz4", records.size(), lz4_stored(records)));
  }
  const auto images = open_bytes(bytes);
  ASSERT_TRUE(images.ok()) << images.error().message;
  EXPECT_EQ((*images)->topic(), "/camera/image_raw");
  ASSERT_EQ((*images)->stamps_ns().size(), 8U);
  EXPECT_EQ((*images)->stamps_ns()[0], kNsPerS);
  EXPECT_EQ((*images)->stamps_ns()[7], 4 * kNsPerS + 7);
  expect_picture(**images, 7, 13);
  expect_picture(**images, 0, 1);
  expect_picture(**images, 2, 0);
  expect_picture(**images, 3, 10);
}

TEST_F(LoggedImagesTest, ReadsMcapOfBothRosInChunksAndOutsideOfThem) {
  for (const Wire wire : {Wire::kRos1, Wire::kCdrLittle, Wire::kCdrBig}) {
    const bool ros1 = wire == Wire::kRos1;
    Bytes declarations =
        testing::mcap_schema(1, ros1 ? "sensor_msgs/Image" : "sensor_msgs/msg/Image");
    append(declarations, testing::mcap_channel(3, 1, "/image", ros1 ? "ros1" : "cdr"));
    Bytes records = declarations;
    for (int i = 0; i < 3; ++i) {
      append(records, testing::mcap_message(3, i, ros_picture(wire, i * kNsPerS + 5, i)));
    }
    const Bytes last = testing::mcap_message(3, 9, ros_picture(wire, 9 * kNsPerS, 9));
    Bytes bytes = testing::mcap_start(ros1 ? "ros1" : "ros2");
    append(bytes, testing::mcap_chunk(lz4_stored(records), records.size(), 0, "lz4"));
    append(bytes, last);
    append(bytes, testing::mcap_end());
    const auto images = open_bytes(bytes, "/image");
    ASSERT_TRUE(images.ok()) << images.error().message;
    EXPECT_THAT((*images)->stamps_ns(), ElementsAre(5, kNsPerS + 5, 2 * kNsPerS + 5, 9 * kNsPerS));
    expect_picture(**images, 3, 9);
    expect_picture(**images, 1, 1);
  }
}

TEST_F(LoggedImagesTest, ReadsLcmImagesOfOverflyAndLibbot) {
  Bytes bytes;
  for (int i = 0; i < 3; ++i) {
    append(bytes, testing::lcm_event(2 * i, i, "OVERFLY_IMAGE", own_lcm_picture(i * kNsPerS, i)));
    append(bytes, testing::lcm_event(2 * i + 1, i, "CAM", libbot_picture(1000 * i, 20 + i)));
  }
  for (const auto& [channel, number] : {std::pair("OVERFLY_IMAGE", 0), std::pair("CAM", 20)}) {
    const auto images = open_bytes(bytes, channel);
    ASSERT_TRUE(images.ok()) << images.error().message;
    const std::int64_t step_ns = number == 0 ? kNsPerS : 1'000'000;
    EXPECT_THAT((*images)->stamps_ns(), ElementsAre(0, step_ns, 2 * step_ns));
    expect_picture(**images, 2, number + 2);
  }
  const auto unnamed = open_bytes(bytes);
  ASSERT_FALSE(unnamed.ok());
  EXPECT_THAT(unnamed.error().message, HasSubstr("OVERFLY_IMAGE, CAM"));
}

TEST_F(LoggedImagesTest, ReadsCompressedImagesAsTheyAre) {
  const Bytes file = {0xFF, 0xD8, 1, 2, 3, 4, 5};
  Bytes message = WireWriter(Wire::kRos1).header(5, "camera").text("jpeg").bytes();
  testing::put(message, static_cast<std::uint32_t>(file.size()));
  append(message, file);
  Bytes bytes = bag_start(1);
  append(bytes, bag_connection(0, "/c", "sensor_msgs/CompressedImage"));
  append(bytes, bag_message(0, 1, message));
  const auto images = open_bytes(bytes);
  ASSERT_TRUE(images.ok()) << images.error().message;
  const auto picture = (*images)->read(0);
  ASSERT_TRUE(picture.ok()) << picture.error().message;
  EXPECT_EQ(picture->encoding, "compressed");
  EXPECT_EQ(Bytes(picture->data.begin(), picture->data.end()), file);
}

TEST_F(LoggedImagesTest, NamesTheTopicsThatThereAre) {
  Bytes bytes = bag_start(1);
  append(bytes, bag_connection(0, "/a", "sensor_msgs/Image"));
  append(bytes, bag_message(0, 1, ros_picture(Wire::kRos1, 5, 1)));
  EXPECT_THAT(open_bytes(bytes, "/b").error().message,
              HasSubstr("topic = /b: has no images that can be read (topics of images: /a)"));
  EXPECT_THAT(open_bytes(bag_start(1)).error().message, HasSubstr("contains no images"));
  const auto tlog = testing::frame_bytes(30, testing::attitude_payload(1, 0, 0, 0), 0);
  Bytes logged(8, 0);
  for (int i = 0; i < 8; ++i) {
    logged[static_cast<std::size_t>(i)] =
        static_cast<std::uint8_t>(std::uint64_t{1'700'000'000'000'000} >> (56 - 8 * i));
  }
  append(logged, tlog);
  EXPECT_THAT(open_bytes(logged).error().message, HasSubstr("tlog holds no images"));
}

TEST_F(LoggedImagesTest, NamesAnyTopicsInALineThatCanBePrinted) {
  Bytes bytes = bag_start(1);
  for (std::uint32_t i = 0; i < 50; ++i) {
    const std::string name = "/\x1b[31m\xFF" + std::to_string(i) + std::string(300, 'x');
    append(bytes, bag_connection(i, name, "sensor_msgs/Image"));
    append(bytes, bag_message(i, 1, ros_picture(Wire::kRos1, 5, 1)));
  }
  const std::string message = open_bytes(bytes).error().message;
  EXPECT_THAT(message, HasSubstr("one must be named: /?[31m?0xxx"));
  EXPECT_THAT(message, HasSubstr(" and 30 more"));
  EXPECT_LT(message.size(), 3000U);
  EXPECT_TRUE(std::all_of(message.begin(), message.end(), [](char c) { return c >= ' '; }));
}

TEST_F(LoggedImagesTest, DoesNotBelieveLengthsOfDamagedImages) {
  // Numbers of height, width, step and size that do not fit the bytes that are there.
  const std::vector<std::function<void(Bytes&)>> damages = {
      [](Bytes& image) { image.resize(image.size() - 1); },
      [](Bytes& image) { image[22] = 0xFF; },           // height
      [](Bytes& image) { image[26 + 3] = 0x7F; },       // width
      [](Bytes& image) { image[26 + 4 + 9 + 1] = 1; },  // step
  };
  for (const auto& damage : damages) {
    Bytes image = ros_picture(Wire::kRos1, 5, 1);
    damage(image);
    Bytes bytes = bag_start(1);
    append(bytes, bag_connection(0, "/a", "sensor_msgs/Image"));
    append(bytes, bag_message(0, 1, image));
    append(bytes, bag_message(0, 1, ros_picture(Wire::kRos1, 9, 2)));
    const auto images = open_bytes(bytes);
    ASSERT_TRUE(images.ok()) << images.error().message;
    const auto broken = (*images)->read(0);
    ASSERT_FALSE(broken.ok());
    EXPECT_THAT(broken.error().message, HasSubstr("image 0 of /a: ends early"));
    expect_picture(**images, 1, 2);
  }
}

TEST_F(LoggedImagesTest, LeavesOutRepeatedStampsAndHeadersThatEndEarly) {
  Bytes bytes = bag_start(1);
  append(bytes, bag_connection(0, "/a", "sensor_msgs/Image"));
  append(bytes, bag_message(0, 1, ros_picture(Wire::kRos1, 5, 1)));
  append(bytes, bag_message(0, 1, ros_picture(Wire::kRos1, 5, 2)));
  append(bytes, bag_message(0, 1, {1, 2, 3}));
  const auto images = open_bytes(bytes);
  ASSERT_TRUE(images.ok()) << images.error().message;
  EXPECT_EQ((*images)->stamps_ns().size(), 1U);
  EXPECT_THAT((*images)->warnings(), Contains(HasSubstr("1 images have the time stamp")));
  EXPECT_THAT((*images)->warnings(), Contains(HasSubstr("1 images are shorter")));
}

}  // namespace
}  // namespace overfly::flight::logs
