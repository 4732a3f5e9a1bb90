#include "server/imagery/grey_picture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "core/outside/file_text.hpp"
#include "server/files/jpeg.hpp"
#include "server/files/png_file.hpp"
#include "tests/support/support.hpp"

namespace overfly::server {
namespace {

using flight::logs::LoggedPicture;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

LoggedPicture picture_of(const std::string& encoding,
                         int width,
                         int height,
                         std::size_t row_bytes,
                         const std::vector<std::uint8_t>& data) {
  LoggedPicture picture;
  picture.encoding = encoding;
  picture.width_px = width;
  picture.height_px = height;
  picture.row_bytes = row_bytes;
  picture.data = data;
  return picture;
}

TEST(GreyPicture, TakesGreyWithPaddedRowsAndTheUpperBitsOfDeepSamples) {
  const std::vector<std::uint8_t> grey = {1, 2, 99, 3, 4, 99};
  EXPECT_THAT(grey_picture(picture_of("mono8", 2, 2, 3, grey))->data, ElementsAre(1, 2, 3, 4));
  const std::vector<std::uint8_t> deep = {0x34, 0x12, 0xCD, 0xAB};
  LoggedPicture picture = picture_of("mono16", 2, 1, 4, deep);
  EXPECT_THAT(grey_picture(picture)->data, ElementsAre(0x12, 0xAB));
  picture.big_endian = true;
  EXPECT_THAT(grey_picture(picture)->data, ElementsAre(0x34, 0xCD));
}

TEST(GreyPicture, TakesTheLumaOfEveryOrderOfColours) {
  // BT.601: 0.299 R + 0.587 G + 0.114 B.
  const std::vector<std::uint8_t> rgb = {200, 100, 50};
  EXPECT_THAT(grey_picture(picture_of("rgb8", 1, 1, 3, rgb))->data, ElementsAre(124));
  const std::vector<std::uint8_t> bgra = {50, 100, 200, 7};
  EXPECT_THAT(grey_picture(picture_of("bgra8", 1, 1, 4, bgra))->data, ElementsAre(124));
  const std::vector<std::uint8_t> yuv = {10, 200, 20, 100};
  EXPECT_THAT(grey_picture(picture_of("uyvy", 2, 1, 4, yuv))->data, ElementsAre(200, 100));
  EXPECT_THAT(grey_picture(picture_of("yuyv", 2, 1, 4, yuv))->data, ElementsAre(10, 20));
}

TEST(GreyPicture, InterpolatesBayerPatterns) {
  // A uniform colour is exact for every pattern; (200, 100, 50) has the luma 124.
  for (const std::string pattern : {"rggb", "bggr", "gbrg", "grbg"}) {
    std::vector<std::uint8_t> data(36);
    for (std::size_t i = 0; i < data.size(); ++i) {
      const char colour = pattern[2 * (i / 6 % 2) + i % 2];
      data[i] = colour == 'r' ? 200 : colour == 'g' ? 100 : 50;
    }
    const auto grey = grey_picture(picture_of("bayer_" + pattern + "8", 6, 6, 6, data));
    ASSERT_TRUE(grey.ok());
    EXPECT_THAT(grey->data, ::testing::Each(124)) << pattern;
  }
  // The red of the pixel between two red ones is their mean.
  const std::vector<std::uint8_t> row = {0, 0, 100, 0};
  const auto grey = grey_picture(picture_of("bayer_rggb8", 4, 1, 4, row));
  EXPECT_EQ(grey->at(1, 0), 15);  // 0.299 * 50
}

TEST(GreyPicture, DecodesJpegAndPng) {
  Image image(32, 24, 1);
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    image.data[i] = static_cast<std::uint8_t>(i / 32 * 10);
  }
  const auto jpeg = encode_jpeg(image, 95);
  ASSERT_TRUE(jpeg.ok());
  const auto from_jpeg = grey_picture(picture_of("compressed", 0, 0, 0, *jpeg));
  ASSERT_TRUE(from_jpeg.ok()) << from_jpeg.error().message;
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    EXPECT_NEAR(from_jpeg->data[i], image.data[i], 6);
  }
  overfly::testing::TemporaryFolder folder;
  ASSERT_TRUE(write_png_file(folder.path() / "a.png", image).ok());
  const auto png = read_file_bytes(folder.path() / "a.png", 1 << 20U);
  const auto from_png = grey_picture(picture_of("compressed", 0, 0, 0, *png));
  ASSERT_TRUE(from_png.ok()) << from_png.error().message;
  EXPECT_EQ(from_png->data, image.data);
}

TEST(GreyPicture, RefusesWhatItCannotRead) {
  const std::vector<std::uint8_t> data(16, 1);
  EXPECT_THAT(grey_picture(picture_of("rgb8", 4, 1, 11, data)).error().message,
              HasSubstr("rows of 11 bytes are too short for 4 px of rgb8"));
  EXPECT_EQ(grey_picture(picture_of("32FC1", 4, 1, 16, data)).error().code,
            ErrorCode::kUnsupported);
  EXPECT_FALSE(grey_picture(picture_of("compressed", 0, 0, 0, data)).ok());
}

}  // namespace
}  // namespace overfly::server
