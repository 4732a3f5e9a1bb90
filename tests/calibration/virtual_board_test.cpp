#include "calibration/virtual/virtual_board.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "calibration/marker_dictionary.hpp"
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

/// What a place of a board with markers shows; `column` and `row` in squares from the first corner.
double shade_of(const Board& board, double column, double row) {
  const int i = static_cast<int>(std::floor(column));
  const int j = static_cast<int>(std::floor(row));
  if (i < -2 || i > board.cols || j < -2 || j > board.rows) return 0.5;
  if (i == -2 || i == board.cols || j == -2 || j == board.rows) return 1.0;
  if ((i + j) % 2 == 0) return 0.0;
  const int bits = board.markers->bits;
  const double cell = board.markers->side_m / board.square_m / (bits + 2);
  const double gap = 0.5 * (1.0 - (bits + 2) * cell);
  const int x = static_cast<int>(std::floor((column - i - gap) / cell));
  const int y = static_cast<int>(std::floor((row - j - gap) / cell));
  if (x < 0 || x > bits + 1 || y < 0 || y > bits + 1) return 1.0;
  if (x == 0 || x == bits + 1 || y == 0 || y == bits + 1) return 0.0;
  const std::uint64_t cells = marker_cells(bits, board.marker_of(i, j).value());
  return marker_cell(bits, cells, y - 1, x - 1) ? 1.0 : 0.0;
}

/// From cells of several pixels to pixels of several squares: the mean of a grid of 64 x 64 places.
TEST(VirtualBoard, CoversMarkersByTheirArea) {
  const Board board{6, 4, 1.0, BoardMarkers{4, 0.7}};
  for (const double square_px : {37.3, 6.1, 1.7, 0.45}) {
    const CameraModel camera(PinholeCamera{48, 40, 10 * square_px, 10 * square_px, 20.3, 17.8});
    const Pose pose{Eigen::Quaterniond::Identity(), {-3.0, -1.5, 10.0}};
    const RadianceImage image = BoardPainter(camera).draw(board, pose, {0.0F, 1.0F, 0.5F});
    double largest = 0.0;
    for (int y = 0; y < 40; ++y) {
      for (int x = 0; x < 48; ++x) {
        double sum = 0.0;
        for (int sample = 0; sample < 4096; ++sample) {
          const double px = x - 0.5 + (sample % 64 + 0.5) / 64.0;
          const double py = y - 0.5 + (sample / 64 + 0.5) / 64.0;
          sum += shade_of(board, (px - 20.3) / square_px + 3.0, (py - 17.8) / square_px + 1.5);
        }
        largest = std::max(largest, std::abs(image.at(x, y) - sum / 4096.0));
      }
    }
    // At most 0.022 by the two grids of samples; lines of a marker that are missed make 0.2 to 0.7.
    EXPECT_LT(largest, 0.03) << square_px;
  }
}

/// Rays that are not kept give the same picture: a part of a large one, and a small camera with
/// that part's image.
TEST(VirtualBoard, LargeCamerasDrawTheSame) {
  const PinholeCamera large{2100, 2100, 700.0, 710.0, 1049.5, 1050.25};
  ASSERT_GT(std::size_t{2101} * 2101, BoardPainter::kMostKeptRays);
  PinholeCamera part = large;
  part.width_px = 320;
  part.height_px = 240;
  part.cx_px -= 900;
  part.cy_px -= 950;
  const Distortion lens{DistortionModel::kRadtan, {-0.02, 0.001, 0.0, 0.0, 0.0}};
  const Pose pose{Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY())),
                  {-0.1, -0.05, 0.6}};
  const RadianceImage whole = BoardPainter(CameraModel(large, lens)).draw(kSampleBoard, pose);
  const RadianceImage seen = BoardPainter(CameraModel(part, lens)).draw(kSampleBoard, pose);
  int dark = 0;
  int others = 0;
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      dark += seen.at(x, y) < 0.1F ? 1 : 0;
      others += seen.at(x, y) != whole.at(x + 900, y + 950) ? 1 : 0;
    }
  }
  EXPECT_GT(dark, 1000);
  EXPECT_EQ(others, 0);
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
