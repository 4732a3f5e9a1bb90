// ChArUco boards: layout, markers, corners of partly visible boards.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "calibration/calibrator.hpp"
#include "calibration/detection/detect_board.hpp"
#include "calibration/detection/detect_markers.hpp"
#include "calibration/marker_dictionary.hpp"
#include "calibration/virtual/virtual_board.hpp"
#include "calibration/virtual/virtual_views.hpp"
#include "tests/calibration/sample_views.hpp"

namespace overfly::calibration {
namespace {

/// 8 x 6 squares: a chequerboard of this size would look the same after half a turn.
Board charuco_board(int bits) { return {7, 5, 0.04, BoardMarkers{bits, 0.03}}; }

/// Squares of at least 20 px in the virtual views of the sample cameras.
Board coarse_charuco_board(int bits) { return {5, 5, 0.04, BoardMarkers{bits, 0.028}}; }

Image charuco_image(const BoardPainter& painter, const Board& board, const Pose& pose) {
  return grey_from(slightly_blurred(painter.draw(board, pose)));
}

/// Distances of the found corners from their projections; counts them.
struct FoundCorners {
  int count = 0;
  double rms_px = 0.0;
  double max_px = 0.0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
};

FoundCorners compare(const BoardView& found, const BoardView& truth) {
  FoundCorners compared;
  for (const BoardCorner& corner : found.corners) {
    const Eigen::Vector2d error =
        corner.pixel - truth.corners[static_cast<std::size_t>(corner.id)].pixel;
    ++compared.count;
    compared.mean += error;
    compared.rms_px += error.squaredNorm();
    compared.max_px = std::max(compared.max_px, error.norm());
  }
  compared.mean /= compared.count;
  compared.rms_px = std::sqrt(compared.rms_px / compared.count);
  return compared;
}

/// The first marker of DICT_4X4_50 as it is printed everywhere: bytes 181, 50.
TEST(MarkerDictionary, BeginsWithTheKnownMarker) {
  EXPECT_EQ(marker_cells(4, 0), 181U * 256U + 50U);
  EXPECT_TRUE(marker_cell(4, marker_cells(4, 0), 0, 0));
  EXPECT_FALSE(marker_cell(4, marker_cells(4, 0), 3, 3));
}

/// No marker looks like another, or like itself, in another orientation.
TEST(MarkerDictionary, FindsEachMarkerInEachOrientationOnly) {
  for (const int bits : {4, 5, 6}) {
    std::set<std::uint64_t> seen;
    for (int id = 0; id < kDictionaryMarkers; ++id) {
      std::uint64_t cells = marker_cells(bits, id);
      for (int turns = 0; turns < 4; ++turns) {
        EXPECT_TRUE(seen.insert(cells).second) << bits << " " << id;
        const auto match = find_marker(bits, cells);
        ASSERT_TRUE(match.has_value());
        EXPECT_EQ(match->id, id);
        EXPECT_EQ(match->turns, turns);
        // Clockwise: the new first row is the old first column, from below.
        std::uint64_t turned = 0;
        for (int row = 0; row < bits; ++row) {
          for (int col = 0; col < bits; ++col) {
            turned = turned << 1U | (marker_cell(bits, cells, bits - 1 - col, row) ? 1U : 0U);
          }
        }
        cells = turned;
      }
    }
  }
}

TEST(CharucoBoard, NumbersMarkersRowByRowInBrightSquares) {
  for (const auto& [cols, rows] :
       {std::pair(7, 5), std::pair(6, 5), std::pair(6, 4), std::pair(7, 4)}) {
    const Board board{cols, rows, 0.04, BoardMarkers{4, 0.03}};
    int next = 0;
    for (int j = -1; j < rows; ++j) {
      for (int i = -1; i < cols; ++i) {
        const bool bright = (i + j + 2) % 2 == 1;
        EXPECT_EQ(board.marker_of(i, j), bright ? std::optional<int>(next) : std::nullopt);
        if (!bright) continue;
        EXPECT_EQ(board.marker_square(next++), Eigen::Vector2i(i, j));
      }
    }
    EXPECT_EQ(board.marker_count(), next);
    EXPECT_FALSE(board.marker_of(cols, 0).has_value());
    EXPECT_FALSE(board.marker_of(-2, 0).has_value());
  }
}

TEST(CharucoBoard, IsNeverAmbiguousButHasLimits) {
  EXPECT_TRUE(require_unambiguous(charuco_board(4)).ok());
  EXPECT_TRUE(charuco_board(4).validate().ok());
  EXPECT_FALSE((Board{7, 5, 0.04, BoardMarkers{7, 0.03}}).validate().ok());
  EXPECT_FALSE((Board{7, 5, 0.04, BoardMarkers{4, 0.0}}).validate().ok());
  EXPECT_FALSE((Board{7, 5, 0.04, BoardMarkers{4, 0.04}}).validate().ok());
  EXPECT_FALSE((Board{7, 5, 0.04, BoardMarkers{4, std::nan("")}}).validate().ok());
  EXPECT_FALSE((Board{30, 30, 0.04, BoardMarkers{4, 0.03}}).validate().ok());
}

TEST(Charuco, FindsTheProjectedCornersWithoutBias) {
  for (const int bits : {4, 5, 6}) {
    const Board board = coarse_charuco_board(bits);
    for (const CameraModel& camera : {radtan_camera(), equidistant_camera()}) {
      const std::vector<Pose> poses = virtual_views(camera, board, 5, 5);
      const std::vector<BoardView> truth = exact_views(camera, board, poses);
      const BoardPainter painter(camera);
      Eigen::Vector2d mean = Eigen::Vector2d::Zero();
      int found_views = 0;
      for (std::size_t i = 0; i < poses.size(); ++i) {
        const auto found = detect_board(charuco_image(painter, board, poses[i]), board);
        ASSERT_TRUE(found.ok());
        if (!*found) continue;  // its markers or gaps are too small
        const FoundCorners compared = compare(**found, truth[i]);
        EXPECT_LT(compared.rms_px, 0.2) << bits << " bits, view " << i;
        EXPECT_LT(compared.max_px, 0.8) << bits << " bits, view " << i;
        mean += compared.mean;
        ++found_views;
      }
      EXPECT_GE(found_views, 3) << bits;
      EXPECT_LT((mean / found_views).norm(), 0.04) << bits;
    }
  }
}

TEST(Charuco, NumbersTheCornersOfAPartOfATurnedBoard) {
  const Board board = charuco_board(4);
  const CameraModel camera = pinhole_camera();
  const BoardPainter painter(camera);
  const Eigen::Vector3d middle(3 * 0.04, 2 * 0.04, 0.0);
  for (const double turn_deg : {0.0, 90.0, 145.0, 180.0, 270.0}) {
    const Eigen::Quaterniond R(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX()) *
                               Eigen::AngleAxisd(rad_from_deg(turn_deg), Eigen::Vector3d::UnitZ()));
    // The middle of the board lies near the image's left edge.
    const Pose pose{R, Eigen::Vector3d(-0.2, 0, 0.45) - R * middle};
    Image image = charuco_image(painter, board, pose);
    // A hand before the board.
    for (int y = 200; y < 260; ++y) {
      for (int x = 100; x < 160; ++x) image.at(x, y) = 120;
    }
    const auto found = detect_board(image, board);
    ASSERT_TRUE(found.ok());
    ASSERT_TRUE(found->has_value()) << turn_deg;
    const FoundCorners compared = compare(**found, exact_views(camera, board, {pose}).front());
    EXPECT_LT(compared.count, board.corner_count()) << turn_deg;
    EXPECT_LT(compared.max_px, 0.6) << turn_deg;
  }
}

TEST(Charuco, FindsNothingInNoiseAndWithoutMarkers) {
  Image noise(640, 480, 1);
  std::mt19937_64 random(1);
  for (std::uint8_t& value : noise.data) value = static_cast<std::uint8_t>(random() >> 56U);
  const Board board = charuco_board(4);
  auto found = detect_board(noise, board);
  ASSERT_TRUE(found.ok());
  EXPECT_FALSE(found->has_value());
  const CameraModel camera = pinhole_camera();
  const BoardPainter painter(camera);
  const Board plain{7, 5, 0.04};
  const Pose pose = virtual_views(camera, plain, 1, 1).front();
  found = detect_board(charuco_image(painter, plain, pose), board);
  ASSERT_TRUE(found.ok());
  EXPECT_FALSE(found->has_value());
}

TEST(Charuco, CalibratesARadtanCamera) {
  const CameraModel camera = radtan_camera();
  const BoardPainter painter(camera);
  const Board board = coarse_charuco_board(4);
  auto calibrator = Calibrator::create({board, {DistortionModel::kRadtan, false}, false});
  ASSERT_TRUE(calibrator.ok());
  for (const Pose& pose : virtual_views(camera, board, 36, 1)) {
    ASSERT_TRUE(calibrator->add(charuco_image(painter, board, pose), "v").ok());
  }
  EXPECT_GE(calibrator->views().size(), 15U);
  const auto found = calibrator->solve();
  ASSERT_TRUE(found.ok()) << found.error().message;
  const PinholeCamera& a = found->camera.pinhole();
  const PinholeCamera& b = camera.pinhole();
  EXPECT_NEAR(a.fx_px, b.fx_px, 1e-3 * b.fx_px);
  EXPECT_NEAR(a.fy_px, b.fy_px, 1e-3 * b.fy_px);
  // The errors are those of the corners' noise, not of the method.
  EXPECT_LT(std::abs(a.fx_px - b.fx_px), 4.0 * found->deviation.fx_px);
  EXPECT_LT(std::abs(a.fy_px - b.fy_px), 4.0 * found->deviation.fy_px);
  EXPECT_LT(found->deviation.fx_px, 1e-3 * b.fx_px);
  EXPECT_NEAR(a.cx_px, b.cx_px, 0.5);
  EXPECT_NEAR(a.cy_px, b.cy_px, 0.5);
  const double k1 = camera.distortion().k[0];
  EXPECT_NEAR(found->camera.distortion().k[0], k1, 0.02 * std::abs(k1));
  EXPECT_LT(found->rms_px, 0.15);
}

}  // namespace
}  // namespace overfly::calibration
