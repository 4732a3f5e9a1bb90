// The self-test's measure against known shifts and against OpenCV's tracker.
#include "renderer/probes/registration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <vector>

#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;

/// Natural paint sampled every 0.3 m, moved by a fraction of a pixel: exact, not resampled.
Image paint(double right_px, double down_px) {
  Image image(kWidth, kHeight, 1);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const double grey =
          overfly::testing::natural_paint(0.3 * (x - right_px), -0.3 * (y - down_px));
      image.at(x, y) = static_cast<std::uint8_t>(std::clamp(grey + 0.5, 0.0, 255.0));
    }
  }
  return image;
}

Image all_valid() { return {kWidth, kHeight, 1, std::uint8_t{255}}; }

TEST(RegisterImages, MeasuresAKnownShift) {
  for (const Eigen::Vector2d& shift :
       {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(0.3, -0.2), Eigen::Vector2d(-1.4, 0.75)}) {
    const Registration measured =
        register_images(paint(shift.x(), shift.y()), paint(0, 0), all_valid());
    ASSERT_GT(measured.patches, 30);
    EXPECT_EQ(measured.lost, 0);
    // Rounding to 8 bit and bilinear samples: hundredths of a pixel.
    EXPECT_NEAR(measured.median_px, shift.norm(), 0.02);
    EXPECT_LT((measured.mean_px - shift).norm(), 0.02);
  }
}

TEST(RegisterImages, AgreesWithOpenCvsTracker) {
  const Image seen = paint(0, 0);
  const Image predicted = paint(0.62, 0.41);
  const Registration measured = register_images(predicted, seen, all_valid());
  const auto mat = [](const Image& image) {
    return cv::Mat(image.height_px,
                   image.width_px,
                   CV_8UC1,
                   const_cast<std::uint8_t*>(image.data.data()))
        .clone();
  };
  std::vector<cv::Point2f> points, tracked;
  for (float y = 30; y < kHeight - 30; y += 24) {
    for (float x = 30; x < kWidth - 30; x += 24) points.emplace_back(x, y);
  }
  std::vector<std::uint8_t> status;
  cv::calcOpticalFlowPyrLK(mat(seen), mat(predicted), points, tracked, status, cv::noArray());
  std::vector<double> motion_px;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (status[i] != 0) motion_px.push_back(cv::norm(tracked[i] - points[i]));
  }
  ASSERT_GT(motion_px.size(), 30U);
  const auto middle = motion_px.begin() + static_cast<std::ptrdiff_t>(motion_px.size() / 2);
  std::nth_element(motion_px.begin(), middle, motion_px.end());
  EXPECT_NEAR(measured.median_px, *middle, 0.02);
}

TEST(RegisterImages, CountsPatchesThatAreNowhere) {
  const Registration measured = register_images(paint(40, 13), paint(0, 0), all_valid());
  EXPECT_GT(measured.p95_px, 3.0);
  EXPECT_GT(measured.median_grey, 5.0);
}

TEST(RegisterImages, LeavesOutInvalidAndSmoothPlaces) {
  EXPECT_EQ(register_images(paint(0, 0), paint(0, 0), Image(kWidth, kHeight, 1)).patches, 0);
  const Image smooth(kWidth, kHeight, 1, std::uint8_t{90});
  EXPECT_EQ(register_images(smooth, smooth, all_valid()).patches, 0);
}

TEST(WarpAlong, TakesTheSourceWhereTheMotionPoints) {
  const Image source = paint(0, 0);
  VectorImage motion(kWidth, kHeight, 2, 0.0F);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      motion.at(x, y, 0) = 1.25F;
      motion.at(x, y, 1) = -0.5F;
    }
  }
  motion.at(50, 50, 0) = std::numeric_limits<float>::quiet_NaN();
  const WarpedImage warped = warp_along(source, motion);
  EXPECT_EQ(warped.valid.at(50, 50), 0);
  EXPECT_EQ(warped.valid.at(kWidth - 2, 50), 0);
  EXPECT_EQ(warped.valid.at(100, 100), 255);
  // The exact image there; the paint has structure down to 5 px, which cubics follow closely.
  const Image wanted = paint(-1.25, 0.5);
  double sum = 0.0;
  int count = 0;
  for (int y = 4; y < kHeight - 4; ++y) {
    for (int x = 4; x < kWidth - 4; ++x) {
      if (warped.valid.at(x, y) == 0) continue;
      sum += std::abs(warped.image.at(x, y) - wanted.at(x, y));
      ++count;
    }
  }
  EXPECT_GT(count, 70000);
  EXPECT_LT(sum / count, 1.5);
}

}  // namespace
}  // namespace overfly::renderer
