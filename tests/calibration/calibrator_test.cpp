#include "calibration/calibrator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "calibration/virtual/virtual_board.hpp"
#include "calibration/virtual/virtual_views.hpp"
#include "tests/calibration/sample_views.hpp"

namespace overfly::calibration {
namespace {

Image image_of(const BoardPainter& painter, const Pose& pose) {
  return grey_from(painter.draw(kSampleBoard, pose));
}

CalibratorOptions options_for(DistortionModel model) {
  return {kSampleBoard, {model, false}, false};
}

/// The limits that the project sets itself for known cameras: fx to 0.1 %, the principal point to
/// 0.5 px, k1 to 2 %, an RMS below 0.15 px.
void expect_within_limits(const Calibration& found, const CameraModel& truth) {
  const PinholeCamera& a = found.camera.pinhole();
  const PinholeCamera& b = truth.pinhole();
  EXPECT_NEAR(a.fx_px, b.fx_px, 1e-3 * b.fx_px);
  EXPECT_NEAR(a.fy_px, b.fy_px, 1e-3 * b.fy_px);
  EXPECT_NEAR(a.cx_px, b.cx_px, 0.5);
  EXPECT_NEAR(a.cy_px, b.cy_px, 0.5);
  EXPECT_LT(found.rms_px, 0.15);
}

TEST(Calibrator, RecoversARadtanCameraFromImages) {
  const CameraModel camera = radtan_camera();
  const BoardPainter painter(camera);
  auto calibrator = Calibrator::create(options_for(DistortionModel::kRadtan));
  ASSERT_TRUE(calibrator.ok());
  for (const Pose& pose : virtual_views(camera, kSampleBoard, 18, 1)) {
    const auto verdict = calibrator->add(image_of(painter, pose), "v");
    ASSERT_TRUE(verdict.ok());
    EXPECT_EQ(*verdict, ViewVerdict::kTaken);
  }
  const auto found = calibrator->solve();
  ASSERT_TRUE(found.ok()) << found.error().message;
  expect_within_limits(*found, camera);
  const double k1 = camera.distortion().k[0];
  EXPECT_NEAR(found->camera.distortion().k[0], k1, 0.02 * std::abs(k1));
  EXPECT_EQ(found->camera.distortion().k[4], 0.0);
  for (const CoverageBar& bar : found->coverage) EXPECT_GT(bar.progress, 0.7) << bar.name;
}

TEST(Calibrator, RecoversAFisheyeFromImages) {
  const CameraModel camera = equidistant_camera();
  const BoardPainter painter(camera);
  auto calibrator = Calibrator::create(options_for(DistortionModel::kEquidistant));
  ASSERT_TRUE(calibrator.ok());
  for (const Pose& pose : virtual_views(camera, kSampleBoard, 27, 1)) {
    ASSERT_TRUE(calibrator->add(image_of(painter, pose), "v").ok());
  }
  const auto found = calibrator->solve();
  ASSERT_TRUE(found.ok()) << found.error().message;
  expect_within_limits(*found, camera);
  // k1 to k4 are strongly correlated: the projection is what they determine together.
  for (double angle = 0.05; angle < 1.0; angle += 0.05) {
    const Eigen::Vector3d ray(std::sin(angle), 0.3 * std::sin(angle), std::cos(angle));
    const auto a = found->camera.project(ray);
    const auto b = camera.project(ray);
    ASSERT_TRUE(a && b);
    EXPECT_LT((*a - *b).norm(), 0.5) << angle;
  }
}

TEST(Calibrator, OfALiveCameraTakesStillViewsThatAddSomething) {
  const CameraModel camera = pinhole_camera();
  const BoardPainter painter(camera);
  CalibratorOptions options = options_for(DistortionModel::kRadtan);
  options.live = true;
  auto calibrator = Calibrator::create(options);
  ASSERT_TRUE(calibrator.ok());
  // The first and the last lie in opposite corners of the image.
  const std::vector<Pose> poses = virtual_views(camera, kSampleBoard, 9, 1);
  const Pose& other = poses.back();
  const auto add = [&](const Pose& pose, Capture capture = Capture::kUseful) {
    return *calibrator->add(image_of(painter, pose), "v", capture);
  };
  // Whether the board moves is known from the second image on.
  EXPECT_EQ(add(poses[0]), ViewVerdict::kMoving);
  ASSERT_TRUE(calibrator->seen());
  EXPECT_EQ(calibrator->seen()->corners.size(), 54U);
  EXPECT_EQ(add(poses[0]), ViewVerdict::kTaken);
  EXPECT_EQ(add(poses[0]), ViewVerdict::kNearDuplicate);
  EXPECT_EQ(add(other), ViewVerdict::kMoving);
  EXPECT_EQ(add(other), ViewVerdict::kTaken);
  // Somewhat aside: no near duplicate, but nothing new.
  Pose aside = other;
  aside.translation.x() += 0.02;
  EXPECT_EQ(add(aside), ViewVerdict::kNothingNew);
  EXPECT_EQ(add(aside, Capture::kNow), ViewVerdict::kTaken);
  EXPECT_EQ(add(aside, Capture::kNow), ViewVerdict::kNearDuplicate);
  Image empty = image_of(painter, poses[0]);
  std::fill(empty.data.begin(), empty.data.end(), std::uint8_t{90});
  EXPECT_EQ(*calibrator->add(empty, "v"), ViewVerdict::kNoBoard);
  EXPECT_FALSE(calibrator->seen());
  EXPECT_EQ(calibrator->views().size(), 3U);
}

TEST(Calibrator, TakesAsManyViewsAsItMay) {
  const CameraModel camera = pinhole_camera();
  const BoardPainter painter(camera);
  CalibratorOptions options = options_for(DistortionModel::kRadtan);
  options.most_views = 4;
  auto calibrator = Calibrator::create(options);
  ASSERT_TRUE(calibrator.ok());
  const std::vector<Pose> poses = virtual_views(camera, kSampleBoard, 5, 1);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(*calibrator->add(image_of(painter, poses[i]), "v"), ViewVerdict::kTaken);
  }
  EXPECT_EQ(*calibrator->add(image_of(painter, poses[4]), "v"), ViewVerdict::kEnough);
  options.most_views = 3;
  EXPECT_FALSE(Calibrator::create(options).ok());
}

TEST(Calibrator, TakesAStillBoardOnce) {
  const CameraModel camera = pinhole_camera();
  const BoardPainter painter(camera);
  auto calibrator = Calibrator::create(options_for(DistortionModel::kRadtan));
  ASSERT_TRUE(calibrator.ok());
  const std::vector<Pose> poses = virtual_views(camera, kSampleBoard, 2, 1);
  EXPECT_EQ(*calibrator->add(image_of(painter, poses[0]), "a"), ViewVerdict::kTaken);
  Pose nearly = poses[0];
  nearly.translation.x() += 0.002;  // 3 px of a diagonal of 800
  EXPECT_EQ(*calibrator->add(image_of(painter, nearly), "b"), ViewVerdict::kNearDuplicate);
  EXPECT_EQ(*calibrator->add(image_of(painter, poses[1]), "c"), ViewVerdict::kTaken);
  EXPECT_EQ(calibrator->names(), (std::vector<std::string>{"a", "c"}));
}

TEST(Calibrator, RejectsImagesOfAnotherSizeThanTheFirstView) {
  const CameraModel camera = pinhole_camera();
  const BoardPainter painter(camera);
  auto calibrator = Calibrator::create(options_for(DistortionModel::kRadtan));
  ASSERT_TRUE(calibrator.ok());
  EXPECT_EQ(*calibrator->add(Image(64, 64, 1), "small"), ViewVerdict::kNoBoard);
  const std::vector<Pose> poses = virtual_views(camera, kSampleBoard, 1, 1);
  EXPECT_EQ(*calibrator->add(image_of(painter, poses[0]), "a"), ViewVerdict::kTaken);
  const auto other = calibrator->add(Image(64, 64, 1), "small");
  ASSERT_FALSE(other.ok());
  EXPECT_NE(other.error().message.find("64 x 64"), std::string::npos) << other.error().message;
}

TEST(Calibrator, RefusesSymmetricBoardsUnlessTheyAreAccepted) {
  CalibratorOptions options = options_for(DistortionModel::kRadtan);
  for (const auto& [cols, rows] : {std::pair(9, 7), std::pair(8, 6)}) {
    options.board = {cols, rows, 0.03};
    options.accept_symmetric = false;
    EXPECT_FALSE(Calibrator::create(options).ok());
    options.accept_symmetric = true;
    EXPECT_TRUE(Calibrator::create(options).ok());
  }
}

/// What Board states: either choice of the first corner gives the same intrinsics.
TEST(Calibrate, DoesNotDependOnHalfATurnOfASymmetricBoard) {
  const Board board{8, 6, 0.03};
  const CameraModel camera = radtan_camera();
  std::vector<BoardView> views =
      exact_views(camera, board, virtual_views(camera, board, 10, 2), 0.1);
  const auto straight = calibrate(board, kSampleSize, {}, views);
  for (std::size_t v = 0; v < views.size(); v += 2) {
    for (BoardCorner& corner : views[v].corners) corner.id = board.corner_count() - 1 - corner.id;
    std::reverse(views[v].corners.begin(), views[v].corners.end());
  }
  const auto turned = calibrate(board, kSampleSize, {}, views);
  ASSERT_TRUE(straight.ok() && turned.ok());
  EXPECT_NEAR(straight->camera.pinhole().fx_px, turned->camera.pinhole().fx_px, 1e-5);
  EXPECT_NEAR(straight->camera.distortion().k[0], turned->camera.distortion().k[0], 1e-7);
}

TEST(Calibrate, NeedsFourViews) {
  const CameraModel camera = radtan_camera();
  const auto views = exact_views(camera, kSampleBoard, virtual_views(camera, kSampleBoard, 3, 2));
  const auto found = calibrate(kSampleBoard, kSampleSize, {}, views);
  ASSERT_FALSE(found.ok());
  EXPECT_NE(found.error().message.find("3 views"), std::string::npos) << found.error().message;
}

/// A board parallel to the image at any distance: focal length and distance cannot be separated.
TEST(Calibrate, RefusesViewsThatAreAllParallelToTheImage) {
  const CameraModel camera = pinhole_camera();
  std::vector<Pose> poses;
  for (int i = 0; i < 12; ++i) {
    const double z = 0.5 + 0.05 * i;
    poses.push_back({Eigen::Quaterniond(Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d::UnitZ())),
                     {-0.12 + 0.01 * (i % 3), -0.08 + 0.01 * (i % 4), z}});
  }
  for (const DistortionModel model : {DistortionModel::kNone, DistortionModel::kRadtan}) {
    for (const double noise_px : {0.0, 0.1}) {
      const auto views = exact_views(camera, kSampleBoard, poses, noise_px);
      const auto found = calibrate(kSampleBoard, kSampleSize, {model, false}, views);
      ASSERT_FALSE(found.ok()) << to_string(model) << " " << noise_px << " f "
                               << found->camera.pinhole().fx_px;
      EXPECT_NE(found.error().message.find("tilted"), std::string::npos) << found.error().message;
    }
  }
}

TEST(Calibrate, LeavesOutAViewWithWrongCorners) {
  const CameraModel camera = radtan_camera();
  auto views = exact_views(camera, kSampleBoard, virtual_views(camera, kSampleBoard, 14, 2), 0.1);
  for (BoardCorner& corner : views[5].corners) corner.pixel.x() += corner.id % 2 == 0 ? 4.0 : -4.0;
  const auto found = calibrate(kSampleBoard, kSampleSize, {}, views);
  ASSERT_TRUE(found.ok()) << found.error().message;
  for (std::size_t i = 0; i < views.size(); ++i) {
    EXPECT_EQ(found->views[i].outlier, i == 5) << i;
  }
  EXPECT_NEAR(found->rms_px, 0.1 * std::sqrt(2.0), 0.02);
  EXPECT_GT(found->views[5].rms_px, 3.0);
  EXPECT_NEAR(found->camera.pinhole().fx_px, camera.pinhole().fx_px, 1.0);
}

TEST(Calibrate, ReportsTiltAndResidualsOfEveryView) {
  const CameraModel camera = radtan_camera();
  const std::vector<Pose> poses = virtual_views(camera, kSampleBoard, 9, 2);
  const auto found =
      calibrate(kSampleBoard, kSampleSize, {}, exact_views(camera, kSampleBoard, poses, 0.2));
  ASSERT_TRUE(found.ok());
  double squares = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Vector3d normal = poses[i].rotation * Eigen::Vector3d::UnitZ();
    EXPECT_NEAR(found->views[i].tilt_rad, std::acos(normal.z()), 0.01);
    EXPECT_GE(found->views[i].max_px, found->views[i].rms_px);
    EXPECT_LE(found->views[i].max_px, found->max_px);
    squares += found->views[i].rms_px * found->views[i].rms_px;
  }
  EXPECT_NEAR(found->rms_px, std::sqrt(squares / static_cast<double>(poses.size())), 1e-9);
}

}  // namespace
}  // namespace overfly::calibration
