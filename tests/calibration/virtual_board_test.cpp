#include "calibration/virtual/virtual_board.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "calibration/virtual/virtual_views.hpp"
#include "tests/calibration/sample_views.hpp"

namespace overfly::calibration {
namespace {

/// A board parallel to the image: 1 m per square at 10 m, so f / 10 px per square.
constexpr double kSquarePx = 20.0;

RadianceImage upright(const Eigen::Vector2d& first_corner_px) {
  const CameraModel camera(PinholeCamera{160, 120, 10 * kSquarePx, 10 * kSquarePx, 0.0, 0.0});
  const Pose pose{Eigen::Quaterniond::Identity(),
                  {first_corner_px.x() / kSquarePx, first_corner_px.y() / kSquarePx, 10.0}};
  return BoardPainter(camera).draw({4, 3, 1.0}, pose, {0.0F, 1.0F, 0.5F});
}

TEST(VirtualBoard, CoversPixelsByTheirArea) {
  // The first corner lies a quarter of a pixel right of the centre of pixel 40 and on the edge
  // between rows 29 and 30.
  const RadianceImage image = upright({40.25, 29.5});
  // Left of the corner, below: square (-1, 0) is bright; right: (0, 0) is dark.
  EXPECT_FLOAT_EQ(image.at(39, 35), 1.0F);
  EXPECT_NEAR(image.at(40, 35), 0.75F, 1.0F / 256);  // [39.5, 40.5], the edge at 40.25
  EXPECT_FLOAT_EQ(image.at(41, 35), 0.0F);
  // Above: square (-1, -1) is dark, (0, -1) bright; no row is shared.
  EXPECT_FLOAT_EQ(image.at(39, 29), 0.0F);
  EXPECT_NEAR(image.at(40, 29), 0.25F, 1.0F / 256);
  EXPECT_FLOAT_EQ(image.at(41, 29), 1.0F);
  EXPECT_FLOAT_EQ(image.at(45, 30), 0.0F);
}

TEST(VirtualBoard, HasABorderOfOneSquare) {
  const RadianceImage image = upright({40.0, 40.0});
  const int left = 40 - static_cast<int>(kSquarePx);  // of the squares
  EXPECT_FLOAT_EQ(image.at(left - 5, 30), 1.0F);
  EXPECT_FLOAT_EQ(image.at(left - static_cast<int>(kSquarePx) + 2, 30), 1.0F);
  EXPECT_FLOAT_EQ(image.at(159, 119), 0.5F);
}

TEST(VirtualBoard, ViewsShowTheWholeBoardInAllPartsOfTheImage) {
  for (const CameraModel& camera : {pinhole_camera(), radtan_camera(), equidistant_camera()}) {
    const std::vector<Pose> poses = virtual_views(camera, kSampleBoard, 18, 3);
    ASSERT_EQ(poses.size(), 18U);
    double left = 1e9;
    double right = 0.0;
    for (const BoardView& view : exact_views(camera, kSampleBoard, poses)) {
      for (const BoardCorner& corner : view.corners) {
        EXPECT_GT(corner.pixel.minCoeff(), 2.0);
        EXPECT_LT(corner.pixel.x(), 637.0);
        EXPECT_LT(corner.pixel.y(), 477.0);
        left = std::min(left, corner.pixel.x());
        right = std::max(right, corner.pixel.x());
      }
    }
    EXPECT_LT(left, 80.0);
    EXPECT_GT(right, 560.0);
  }
}

TEST(VirtualBoard, ViewsAreAFunctionOfTheSeed) {
  const CameraModel camera = radtan_camera();
  const auto a = virtual_views(camera, kSampleBoard, 3, 7);
  const auto b = virtual_views(camera, kSampleBoard, 3, 7);
  const auto c = virtual_views(camera, kSampleBoard, 3, 8);
  EXPECT_EQ(a[2].translation, b[2].translation);
  EXPECT_NE(a[2].translation, c[2].translation);
}

}  // namespace
}  // namespace overfly::calibration
