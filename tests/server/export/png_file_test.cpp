// PNG files as OpenCV reads them.
#include "server/files/png_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "tests/support/support.hpp"

namespace overfly::server {
namespace {

using ::testing::HasSubstr;

/// Gradients, a hard edge and something like noise.
template <typename T>
ImageBuffer<T> patterned(int width, int height, int channels) {
  ImageBuffer<T> image(width, height, channels);
  std::uint32_t state = 7;
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    state = state * 1664525U + 1013904223U;
    const std::uint32_t noise = (i / 97) % 3 == 0 ? state >> 12U : 0U;
    image.data[i] = static_cast<T>(i * 257U / static_cast<unsigned>(width) + noise);
  }
  return image;
}

/// OpenCV keeps colours as blue, green, red.
template <typename T>
void expect_equal(const cv::Mat& read, const ImageBuffer<T>& written) {
  ASSERT_EQ(read.cols, written.width_px);
  ASSERT_EQ(read.rows, written.height_px);
  ASSERT_EQ(read.channels(), written.channels);
  ASSERT_EQ(read.depth(), cv::DataType<T>::depth);
  int wrong = 0;
  for (int y = 0; y < read.rows; ++y) {
    for (int x = 0; x < read.cols; ++x) {
      for (int c = 0; c < read.channels(); ++c) {
        const int theirs = read.channels() == 3 ? 2 - c : c;
        wrong += read.ptr<T>(y)[x * read.channels() + theirs] != written.at(x, y, c);
      }
    }
  }
  EXPECT_EQ(wrong, 0);
}

TEST(PngFile, OpenCvReadsEveryKind) {
  const overfly::testing::TemporaryFolder folder;
  const auto file = folder.path() / "image.png";
  for (const auto& [width, height] : {std::pair{1, 1}, {3, 5}, {160, 121}, {641, 480}}) {
    for (const int channels : {1, 3}) {
      SCOPED_TRACE(std::to_string(width) + " px, " + std::to_string(channels));
      const auto image8 = patterned<std::uint8_t>(width, height, channels);
      ASSERT_TRUE(write_png_file(file, image8).ok());
      expect_equal(cv::imread(file.string(), cv::IMREAD_UNCHANGED), image8);
      const auto image16 = patterned<std::uint16_t>(width, height, channels);
      ASSERT_TRUE(write_png_file(file, image16).ok());
      expect_equal(cv::imread(file.string(), cv::IMREAD_UNCHANGED), image16);
    }
  }
}

TEST(PngFile, BytesDependOnTheImageAlone) {
  const auto image = patterned<std::uint8_t>(200, 100, 3);
  EXPECT_EQ(encode_png(image), encode_png(image));
}

TEST(PngFile, NamesWhatItCannotWrite) {
  const Status empty = write_png_file("a.png", Image());
  EXPECT_EQ(empty.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(empty.error().message, HasSubstr("a.png: image of 0 x 0 px"));
  EXPECT_THAT(write_png_file("a.png", Image16(4, 4, 2)).error().message, HasSubstr("2 channels"));
  const Status nowhere = write_png_file("/no/such/folder/a.png", Image(4, 4, 1));
  EXPECT_EQ(nowhere.error().code, ErrorCode::kIo);
  EXPECT_THAT(nowhere.error().message, HasSubstr("/no/such/folder/a.png"));
}

}  // namespace
}  // namespace overfly::server
