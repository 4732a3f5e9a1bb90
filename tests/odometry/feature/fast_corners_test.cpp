// FAST corners: the same as OpenCV's in every cell.
#include "odometry/feature/fast_corners.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "tests/odometry/random_image.hpp"

namespace overfly::odometry::feature {
namespace {

using testing::random_image;

/// Compares all cells. @return number of corners
int compare(const cv::Mat& image, const std::vector<int>& thresholds) {
  int corners = 0;
  std::vector<FastCorner> ours, theirs;
  for (int y = kFastReachPx; y < image.rows - kFastReachPx; y += kFastCellPx) {
    for (int x = kFastReachPx; x < image.cols - kFastReachPx; x += kFastCellPx) {
      const cv::Rect cell(x,
                          y,
                          std::min(kFastCellPx, image.cols - kFastReachPx - x),
                          std::min(kFastCellPx, image.rows - kFastReachPx - y));
      find_fast_corners(image, cell, thresholds, ours);
      find_fast_corners_by_opencv(image, cell, thresholds, theirs);
      EXPECT_EQ(ours.size(), theirs.size()) << cell;
      if (ours.size() != theirs.size()) return corners;
      for (std::size_t i = 0; i < ours.size(); ++i) {
        EXPECT_EQ(ours[i].pixel, theirs[i].pixel) << cell;
        EXPECT_EQ(ours[i].score, theirs[i].score) << cell;
      }
      corners += static_cast<int>(ours.size());
    }
  }
  return corners;
}

TEST(FastCorners, AreThoseOfOpenCvInNoiseOfAnyStrength) {
  const cv::Mat noise = random_image(331, 217, 1);
  EXPECT_GT(compare(noise, {20, 7, 2}), 500);
  for (const double strength : {0.5, 0.1, 0.05, 0.02}) {
    cv::Mat weak;
    noise.convertTo(weak, CV_8U, strength, 100.0);
    EXPECT_GT(compare(weak, {20, 7, 2}), 20) << strength;
    compare(weak, {20, 7});
    compare(weak, {1});
  }
}

TEST(FastCorners, AreThoseOfOpenCvInSmoothAndSteepImages) {
  cv::Mat smooth, steep;
  cv::GaussianBlur(random_image(200, 180, 2), smooth, cv::Size(), 1.5);
  EXPECT_GT(compare(smooth, {20, 7, 2}), 100);
  cv::threshold(smooth, steep, 127.0, 255.0, cv::THRESH_BINARY);
  // Many equal scores, of which none is the largest of its neighbourhood.
  EXPECT_GT(compare(steep, {20, 7, 2}), 10);
  EXPECT_GT(compare(steep, {254, 253}), 10);
  EXPECT_EQ(compare(cv::Mat(80, 90, CV_8U, cv::Scalar(77)), {20, 7, 0}), 0);
}

TEST(FastCorners, ReportsTheCornersOfTheFirstThresholdThatHasAny) {
  cv::Mat image(60, 60, CV_8U, cv::Scalar(100));
  image.at<std::uint8_t>(24, 20) = 110;
  image.at<std::uint8_t>(14, 30) = 103;
  const cv::Rect cell(8, 8, kFastCellPx, kFastCellPx);
  std::vector<FastCorner> corners;
  find_fast_corners(image, cell, std::vector<int>{20, 7, 2}, corners);
  ASSERT_EQ(corners.size(), 1U);
  EXPECT_EQ(corners[0].pixel, cv::Point(20, 24));
  EXPECT_EQ(corners[0].score, 9);
  find_fast_corners(image, cell, std::vector<int>{20, 2}, corners);
  EXPECT_EQ(corners.size(), 2U);
  find_fast_corners(image, cell, std::vector<int>{20, 10}, corners);
  EXPECT_TRUE(corners.empty());
}

}  // namespace
}  // namespace overfly::odometry::feature
