// Half images: equal to OpenCV's, with the saturated pixels counted.
#include "odometry/image/half_image.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <random>

#include "tests/odometry/random_image.hpp"

namespace overfly::odometry {
namespace {

using testing::random_image;

void expect_equal_to_opencv(const cv::Mat& image) {
  const HalfImage half = halved(image);
  cv::Mat expected, full;
  cv::pyrDown(image, expected);
  cv::threshold(image, full, kSaturatedLevel - 1, 255.0, cv::THRESH_BINARY);
  ASSERT_EQ(half.image.size(), expected.size());
  ASSERT_EQ(cv::countNonZero(half.image != expected), 0) << image.cols << "x" << image.rows;
  ASSERT_EQ(half.saturated_px, cv::countNonZero(full)) << image.cols << "x" << image.rows;
  ASSERT_EQ(count_saturated(image), half.saturated_px);
}

TEST(HalfImage, HasOpenCvsBitsAtEverySize) {
  std::mt19937 generator(1);
  for (int columns = 1; columns < 170; ++columns) {
    expect_equal_to_opencv(
        random_image(columns, 1 + static_cast<int>(generator() % 40), generator()));
  }
  for (int rows = 1; rows < 20; ++rows) expect_equal_to_opencv(random_image(99, rows, generator()));
  expect_equal_to_opencv(random_image(1280, 960, generator()));
  expect_equal_to_opencv(random_image(9001, 6, generator()));
}

TEST(HalfImage, HasNoOverflowInWhite) {
  const cv::Mat white(71, 203, CV_8U, cv::Scalar(255));
  expect_equal_to_opencv(white);
  EXPECT_EQ(cv::countNonZero(halved(white).image != 255), 0);
}

TEST(HalfImage, ReadsOnlyTheImage) {
  // A part of a larger image, whose other pixels must not matter.
  std::mt19937 generator(2);
  const cv::Mat whole = random_image(200, 100, generator());
  const cv::Mat part = whole(cv::Rect(20, 10, 130, 61));
  const HalfImage half = halved(part);
  EXPECT_EQ(cv::countNonZero(half.image != halved(part.clone()).image), 0);
}

}  // namespace
}  // namespace overfly::odometry
