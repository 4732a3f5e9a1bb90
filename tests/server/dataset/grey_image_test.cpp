// Image files as others write them (OpenCV), and broken ones.
#include "server/dataset/grey_image.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <opencv2/imgcodecs.hpp>

#include "tests/server/dataset/dataset_fixture.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using overfly::testing::read_text;
using overfly::testing::TemporaryFolder;
using overfly::testing::write_text;
using ::testing::HasSubstr;

class GreyImage : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path file(const std::string& name) const { return folder_.path() / name; }
  Image read(const std::string& name, int bits = 16) {
    const Result<Image> image = read_grey_image(file(name), bits);
    if (image) return *image;
    ADD_FAILURE() << image.error().message;
    return Image(1, 1, 1);
  }
  std::string error(const std::string& name, int bits = 16) {
    const Result<Image> image = read_grey_image(file(name), bits);
    if (!image) return image.error().message;
    ADD_FAILURE() << "read, but should not";
    return "";
  }
  TemporaryFolder folder_;
};

cv::Mat coloured(int type) {
  cv::Mat image(9, 13, type);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols * image.channels(); ++x) {
      image.ptr(y)[x] = static_cast<std::uint8_t>(37 * x + 11 * y);
    }
  }
  return image;
}

TEST_F(GreyImage, KeepsGreyPicturesOfLosslessFormatsAsTheyAre) {
  const cv::Mat written = coloured(CV_8UC1);
  for (const char* name : {"a.png", "a.pgm"}) {
    ASSERT_TRUE(cv::imwrite(file(name).string(), written));
    const Image image = read(name);
    ASSERT_EQ(image.width_px, 13) << name;
    ASSERT_EQ(image.height_px, 9) << name;
    ASSERT_EQ(image.channels, 1) << name;
    for (int i = 0; i < 13 * 9; ++i) {
      ASSERT_EQ(image.data[i], written.data[i]) << name << " at " << i;
    }
  }
}

TEST_F(GreyImage, MakesLumaOfColour) {
  const cv::Mat written = coloured(CV_8UC3);
  for (const char* name : {"a.png", "a.ppm"}) {
    ASSERT_TRUE(cv::imwrite(file(name).string(), written));
    const Image image = read(name);
    ASSERT_EQ(image.channels, 1);
    for (int i = 0; i < 13 * 9; ++i) {
      const cv::Vec3b bgr = written.at<cv::Vec3b>(i / 13, i % 13);
      // ITU-R BT.601
      const double luma = 0.299 * bgr[2] + 0.587 * bgr[1] + 0.114 * bgr[0];
      ASSERT_NEAR(image.data[i], luma, 0.501) << name << " at " << i;
    }
  }
  cv::Mat with_alpha(2, 2, CV_8UC4, cv::Scalar(10, 20, 30, 40));
  ASSERT_TRUE(cv::imwrite(file("alpha.png").string(), with_alpha));
  EXPECT_NEAR(read("alpha.png").at(1, 1), 0.299 * 30 + 0.587 * 20 + 0.114 * 10, 0.501);
}

TEST_F(GreyImage, ReadsJpegAsAnotherDecoderDoes) {
  cv::Mat smooth(40, 60, CV_8UC1);
  for (int y = 0; y < smooth.rows; ++y) {
    for (int x = 0; x < smooth.cols; ++x) smooth.at<std::uint8_t>(y, x) = 2 * x + 3 * y;
  }
  ASSERT_TRUE(cv::imwrite(file("a.jpg").string(), smooth, {cv::IMWRITE_JPEG_QUALITY, 95}));
  const cv::Mat other = cv::imread(file("a.jpg").string(), cv::IMREAD_UNCHANGED);
  const Image image = read("a.jpg");
  ASSERT_EQ(image.data.size(), 40U * 60U);
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    ASSERT_LE(std::abs(image.data[i] - other.data[i]), 1);
  }
}

TEST_F(GreyImage, KeepsTheUpperBitsOfDeepPictures) {
  cv::Mat deep(1, 3, CV_16UC1);
  deep.at<std::uint16_t>(0, 0) = 0;
  deep.at<std::uint16_t>(0, 1) = 0x0ABC;
  deep.at<std::uint16_t>(0, 2) = 0x0FFF;
  ASSERT_TRUE(cv::imwrite(file("a.png").string(), deep));
  EXPECT_THAT(read("a.png", 12).data, ::testing::ElementsAre(0, 0xAB, 0xFF));
  EXPECT_THAT(read("a.png", 16).data, ::testing::ElementsAre(0, 0x0A, 0x0F));
  EXPECT_THAT(error("a.png", 10), HasSubstr("a sample is 2748: must be at most 1023, of 10 bit"));
}

TEST_F(GreyImage, SaysWhatIsWrongWithAFile) {
  EXPECT_THAT(error("none.png"), HasSubstr("none.png: no such file"));
  write_text(file("empty.png"), "");
  EXPECT_THAT(error("empty.png"), HasSubstr("empty.png: is empty"));
  write_text(file("text.png"), "this is no picture");
  EXPECT_THAT(error("text.png"), HasSubstr("must be PNG, JPEG, PGM or PPM"));
  fs::create_directories(file("folder.png"));
  EXPECT_THAT(error("folder.png"), HasSubstr("is a folder"));
}

TEST_F(GreyImage, RefusesPicturesThatAreCutShort) {
  cv::Mat noise(120, 160, CV_8UC1);
  cv::randu(noise, 0, 256);
  for (const char* name : {"a.png", "a.pgm", "a.jpg"}) {
    ASSERT_TRUE(cv::imwrite(file(name).string(), noise));
    const std::string whole = read_text(file(name));
    for (const double share : {0.02, 0.5, 0.95}) {
      const auto size = static_cast<std::size_t>(share * static_cast<double>(whole.size()));
      write_text(file(name), whole.substr(0, size));
      EXPECT_THAT(error(name), HasSubstr(name)) << share;
    }
  }
}

TEST_F(GreyImage, RefusesDeclaredSizesThatTheFileDoesNotHold) {
  write_text(file("huge.pgm"), "P5\n100000 100000\n255\n");
  EXPECT_THAT(error("huge.pgm"),
              HasSubstr("huge.pgm: 100000 x 100000 px: must be at most 16384 a side"));
  const std::string head = " 16384 16384 255\nab";
  write_text(file("tiny.pgm"), "P5" + head);
  EXPECT_THAT(error("tiny.pgm"),
              HasSubstr("tiny.pgm: 21 bytes: must be at least 268435456 for 16384 x 16384 px"));
  write_text(file("tiny.ppm"), "P6" + head);
  EXPECT_THAT(error("tiny.ppm"), HasSubstr("must be at least 805306368 for 16384 x 16384 px"));
}

TEST_F(GreyImage, RefusesMorePixelsThanAreWanted) {
  const cv::Mat grey(120, 160, CV_8UC1, cv::Scalar(90));
  for (const char* name : {"a.png", "a.jpg", "a.pgm"}) {
    ASSERT_TRUE(cv::imwrite(file(name).string(), grey));
    EXPECT_TRUE(read_grey_image(file(name), 16, 19'200).ok()) << name;
    const Result<Image> refused = read_grey_image(file(name), 16, 19'199);
    ASSERT_FALSE(refused.ok()) << name;
    EXPECT_EQ(refused.error().code, ErrorCode::kInvalidArgument);
    EXPECT_THAT(refused.error().message,
                HasSubstr(std::string(name) + ": 160 x 120 px: must have at most 19199 pixels"));
  }
}

TEST(ImageName, IsToldByItsEnding) {
  for (const char* name : {"a.png", "a.JPG", "b/a.jpeg", "a.pgm", "a.ppm"}) {
    EXPECT_TRUE(is_image_name(name)) << name;
  }
  for (const char* name : {"a.txt", "png", "a.png.aux.xml", "a.flo"}) {
    EXPECT_FALSE(is_image_name(name)) << name;
  }
}

}  // namespace
}  // namespace overfly::server
