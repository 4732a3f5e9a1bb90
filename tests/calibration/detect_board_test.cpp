#include "calibration/detection/detect_board.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "calibration/virtual/virtual_board.hpp"
#include "calibration/virtual/virtual_views.hpp"
#include "tests/calibration/sample_views.hpp"

namespace overfly::calibration {
namespace {

struct CornerErrors {
  double rms_px = 0.0;
  double mean_px = 0.0;  ///< length of the mean error: a bias
};

CornerErrors errors_of(const CameraModel& camera, const std::vector<Pose>& poses) {
  const std::vector<BoardView> truth = exact_views(camera, kSampleBoard, poses);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double squares = 0.0;
  int count = 0;
  const BoardPainter painter(camera);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto found = detect_board(grey_from(painter.draw(kSampleBoard, poses[i])), kSampleBoard);
    EXPECT_TRUE(found.ok() && found->has_value()) << "view " << i;
    if (!found || !*found) continue;
    for (std::size_t c = 0; c < truth[i].corners.size(); ++c) {
      const Eigen::Vector2d error = (*found)->corners[c].pixel - truth[i].corners[c].pixel;
      sum += error;
      squares += error.squaredNorm();
      ++count;
    }
  }
  return {std::sqrt(squares / count), sum.norm() / count};
}

TEST(DetectBoard, FindsTheProjectedCornersWithoutBias) {
  for (const CameraModel& camera : {pinhole_camera(), radtan_camera(), equidistant_camera()}) {
    const CornerErrors errors = errors_of(camera, virtual_views(camera, kSampleBoard, 6, 5));
    // A shift of the pixel convention by half a pixel would give a mean of 0.7 px.
    EXPECT_LT(errors.mean_px, 0.02);
    EXPECT_LT(errors.rms_px, 0.08);
  }
}

TEST(DetectBoard, NumbersTheCornersInEveryRotationOfTheBoard) {
  const CameraModel camera = pinhole_camera();
  const Eigen::Vector3d middle(4 * 0.03, 2.5 * 0.03, 0.0);
  for (const double turn_deg : {0.0, 60.0, 90.0, 135.0, 180.0, 200.0, 270.0, 330.0}) {
    const Eigen::Quaterniond R(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()) *
                               Eigen::AngleAxisd(rad_from_deg(turn_deg), Eigen::Vector3d::UnitZ()));
    const Pose pose{R, Eigen::Vector3d(0, 0, 0.55) - R * middle};
    const CornerErrors errors = errors_of(camera, {pose});
    EXPECT_LT(errors.rms_px, 0.1) << turn_deg << " deg";
  }
}

TEST(DetectBoard, FindsNothingInNoiseAndInPartsOfABoard) {
  Image noise(320, 240, 1);
  std::mt19937_64 random(1);
  for (std::uint8_t& value : noise.data) value = static_cast<std::uint8_t>(random() >> 56U);
  const auto in_noise = detect_board(noise, kSampleBoard);
  ASSERT_TRUE(in_noise.ok());
  EXPECT_FALSE(in_noise->has_value());

  const CameraModel camera = pinhole_camera();
  const Pose half_outside{Eigen::Quaterniond::Identity(), {0.1, 0.0, 0.5}};
  const auto part =
      detect_board(grey_from(BoardPainter(camera).draw(kSampleBoard, half_outside)), kSampleBoard);
  ASSERT_TRUE(part.ok());
  EXPECT_FALSE(part->has_value());
}

TEST(DetectBoard, RejectsImagesOutsideItsLimits) {
  EXPECT_FALSE(detect_board(Image(15, 100, 1), kSampleBoard).ok());
  EXPECT_FALSE(detect_board(Image(100, 100, 3), kSampleBoard).ok());
  EXPECT_FALSE(detect_board(Image(), kSampleBoard).ok());
}

}  // namespace
}  // namespace overfly::calibration
