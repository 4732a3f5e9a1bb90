#include "server/views/view_encoding.hpp"
#include "server/record/rows/rows.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "core/camera/halved_image.hpp"
#include "server/files/jpeg.hpp"
#include "tests/support/support.hpp"

namespace overfly::server {
namespace {

std::shared_ptr<const Image> ramp(int width_px, int height_px, int channels) {
  auto image = std::make_shared<Image>(width_px, height_px, channels);
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      for (int c = 0; c < channels; ++c) image->at(x, y, c) = static_cast<std::uint8_t>(2 * x + c);
    }
  }
  return image;
}

PictureRequest request_of(int quality, int max_width_px) {
  PictureRequest request;
  request.quality = quality;
  request.max_width_px = max_width_px;
  return request;
}

TEST(HalvedToFit, KeepsWhatFitsAndAveragesWhatDoesNot) {
  const auto image = ramp(64, 48, 1);
  EXPECT_EQ(halved_to_fit(image, 64), image);
  const auto half = halved_to_fit(image, 63);
  EXPECT_EQ(half->width_px, 32);
  EXPECT_EQ(half->height_px, 24);
  EXPECT_EQ(half->at(5, 3), 21);  // mean of 20, 22, 20, 22
  EXPECT_EQ(halved_to_fit(image, 16)->width_px, 16);
}

TEST(JpegSize, ReadsTheFrameHeader) {
  const auto grey = encode_jpeg(*ramp(70, 40, 1), 80);
  const auto colour = encode_jpeg(*ramp(33, 51, 3), 80);
  ASSERT_TRUE(grey && colour);
  EXPECT_EQ(jpeg_size(*grey)->width_px, 70);
  EXPECT_EQ(jpeg_size(*grey)->height_px, 40);
  EXPECT_TRUE(jpeg_size(*grey)->grey);
  EXPECT_EQ(jpeg_size(*colour)->height_px, 51);
  EXPECT_FALSE(jpeg_size(*colour)->grey);
  for (std::size_t size = 0; size < 30; ++size) {
    (void)jpeg_size({grey->begin(), grey->begin() + static_cast<std::ptrdiff_t>(size)});
  }
  EXPECT_FALSE(jpeg_size({0xFF, 0xD8, 0xFF, 0xD9}));
}

TEST(PictureEncoder, EncodesASharedImageOnce) {
  PictureEncoder encoder;
  const StampedImage image{7, 700, ramp(64, 48, 1)};
  const auto first = encoder.encode(image, request_of(75, 64));
  const auto second = encoder.encode(image, request_of(75, 64));
  const auto smaller = encoder.encode(image, request_of(75, 32));
  ASSERT_TRUE(first && second && smaller);
  EXPECT_EQ(first->bytes, second->bytes);
  EXPECT_EQ(first->frame, 7);
  EXPECT_EQ(smaller->width_px, 32);
}

TEST(PictureEncoder, EncodesAStreamAsVideoWhereItIsAskedTo) {
  PictureEncoder encoder;
  PictureRequest request = request_of(75, 32);
  request.video = VideoChain{1, 2, 0, false};
  const auto first = encoder.encode({7, 700, ramp(64, 48, 1)}, request);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->coding, PictureCoding::kVp8);
  EXPECT_TRUE(first->key);
  EXPECT_EQ(first->width_px, 32);
  EXPECT_EQ(first->full_width_px, 64);
  request.video->pictures = 1;
  EXPECT_FALSE(encoder.encode({8, 800, ramp(64, 48, 1)}, request)->key);
  for (std::uint32_t stream = 10; stream < 10 + VideoEncoders::kMost; ++stream) {
    request.video = VideoChain{1, stream, 0, false};
    const auto picture = encoder.encode({9, 900, ramp(64, 48, 1)}, request);
    ASSERT_TRUE(picture);
    const bool last = stream + 1 == 10 + VideoEncoders::kMost;
    EXPECT_EQ(picture->coding, last ? PictureCoding::kJpeg : PictureCoding::kVp8);
  }
}

TEST(PictureEncoder, PassesARecordedPictureOnWhereItFits) {
  const overfly::testing::TemporaryFolder folder;
  const auto jpeg = encode_jpeg(*ramp(64, 48, 1), 80);
  ASSERT_TRUE(jpeg);
  const auto file = folder.path() / "000003.jpg";
  overfly::testing::write_text(file, {jpeg->begin(), jpeg->end()});
  PictureEncoder encoder;
  const auto whole = encoder.encode_file(file, 3, 300, request_of(75, 64));
  ASSERT_TRUE(whole);
  EXPECT_EQ(*whole->bytes, *jpeg);
  EXPECT_TRUE(whole->grey);
  const auto half = encoder.encode_file(file, 3, 300, request_of(75, 40));
  ASSERT_TRUE(half);
  EXPECT_EQ(half->width_px, 32);
  PictureRequest sparing = request_of(20, 64);
  sparing.sparing = true;
  const auto again = encoder.encode_file(file, 3, 300, sparing);
  ASSERT_TRUE(again);
  EXPECT_LT(again->bytes->size(), jpeg->size()) << "the link is slow: encoded again";
  EXPECT_EQ(again->width_px, 64);
  EXPECT_EQ(
      encoder.encode_file(folder.path() / "none.jpg", 3, 300, request_of(75, 64)).error().code,
      ErrorCode::kNotFound);
  overfly::testing::write_text(folder.path() / "bad.jpg", "no picture");
  EXPECT_FALSE(encoder.encode_file(folder.path() / "bad.jpg", 3, 300, request_of(75, 64)));
}

}  // namespace
}  // namespace overfly::server
