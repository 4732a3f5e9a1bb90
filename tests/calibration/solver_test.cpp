#include "calibration/solver/solve.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "calibration/solver/first_guess.hpp"
#include "calibration/virtual/virtual_views.hpp"
#include "tests/calibration/sample_views.hpp"

namespace overfly::calibration {
namespace {

Solution solved(const std::vector<BoardView>& views, const LensChoice& lens) {
  const auto guess = first_guess(kSampleBoard, kSampleSize, lens, views);
  EXPECT_TRUE(guess.has_value());
  auto solution = solve(kSampleBoard, lens, views, *guess);
  EXPECT_TRUE(solution.ok()) << solution.error().message;
  return *solution;
}

void expect_camera(const CameraModel& found, const CameraModel& truth, double px, double k) {
  EXPECT_NEAR(found.pinhole().fx_px, truth.pinhole().fx_px, px);
  EXPECT_NEAR(found.pinhole().fy_px, truth.pinhole().fy_px, px);
  EXPECT_NEAR(found.pinhole().cx_px, truth.pinhole().cx_px, px);
  EXPECT_NEAR(found.pinhole().cy_px, truth.pinhole().cy_px, px);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(found.distortion().k[i], truth.distortion().k[i], k) << "coefficient " << i;
  }
}

struct LensCase {
  CameraModel camera;
  LensChoice lens;
};

std::vector<LensCase> lens_cases() {
  CameraModel with_k3(radtan_camera().pinhole(),
                      {DistortionModel::kRadtan, {-0.27, 0.07, 0.0008, -0.0006, 0.003}});
  return {{pinhole_camera(), {DistortionModel::kNone, false}},
          {radtan_camera(), {DistortionModel::kRadtan, false}},
          {with_k3, {DistortionModel::kRadtan, true}},
          {equidistant_camera(), {DistortionModel::kEquidistant, false}}};
}

TEST(LensParameters, DerivativesAreThoseOfFiniteDifferences) {
  const Eigen::Vector3d p(0.35, -0.22, 0.8);
  for (const LensCase& each : lens_cases()) {
    const ProjectedPoint at = project_with_derivatives(each.camera, each.lens, p);
    EXPECT_LT((at.pixel - each.camera.project(p).value()).norm(), 1e-10);
    constexpr double kStep = 1e-6;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(i);
      const Eigen::Vector2d slope =
          (each.camera.project(p + step).value() - each.camera.project(p - step).value()) /
          (2 * kStep);
      EXPECT_LT((at.d_point.col(i) - slope).norm(), 1e-4 * (1.0 + slope.norm()));
    }
    const Eigen::VectorXd parameters = parameters_of(each.camera, each.lens);
    for (int i = 0; i < each.lens.parameters(); ++i) {
      const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(parameters.size(), i);
      const auto pixel = [&](const Eigen::VectorXd& moved) {
        return camera_of(moved, each.lens, kSampleSize).project(p).value();
      };
      const Eigen::Vector2d slope =
          (pixel(parameters + step) - pixel(parameters - step)) / (2 * kStep);
      EXPECT_LT((at.d_parameters.col(i) - slope).norm(), 1e-4 * (1.0 + slope.norm())) << i;
    }
  }
}

TEST(Solver, RecoversExactCornersExactly) {
  for (const LensCase& each : lens_cases()) {
    const std::vector<Pose> poses = virtual_views(each.camera, kSampleBoard, 9, 11);
    const Solution solution = solved(exact_views(each.camera, kSampleBoard, poses), each.lens);
    expect_camera(solution.camera, each.camera, 1e-5, 1e-6);
    EXPECT_LT(solution.rms_px, 1e-6);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      EXPECT_LT((solution.T_camera_board[i].translation - poses[i].translation).norm(), 1e-6);
      EXPECT_LT(rotation_angle_rad(solution.T_camera_board[i].rotation, poses[i].rotation), 1e-6);
    }
  }
}

/// Cameras of widely different focal lengths and lenses, from few views with noise.
TEST(Solver, ConvergesFromItsOwnGuessForManyCameras) {
  for (const double f_px : {250.0, 400.0, 900.0, 2500.0}) {
    for (const double k1 : {-0.35, -0.1, 0.1}) {
      if (f_px < 300.0 && k1 < -0.3) continue;  // this lens folds within the image
      const CameraModel camera(PinholeCamera{640, 480, f_px, 1.01 * f_px, 300.0, 260.0},
                               {DistortionModel::kRadtan, {k1, 0.06, 0.001, 0.0, 0.0}});
      if (!camera.validate()) continue;
      const std::vector<Pose> poses = virtual_views(camera, kSampleBoard, 12, 4);
      ASSERT_EQ(poses.size(), 12U);
      const Solution solution = solved(exact_views(camera, kSampleBoard, poses, 0.1), {});
      EXPECT_NEAR(solution.rms_px, 0.1 * std::sqrt(2.0), 0.015) << f_px << " " << k1;
      EXPECT_NEAR(solution.camera.pinhole().fx_px / f_px, 1.0, 0.01) << f_px << " " << k1;
    }
  }
}

/// The spread of 120 estimates over noise of 0.2 px against the predicted standard deviation. A
/// standard deviation of 120 samples is itself known to 1 / sqrt(240) = 6.5 %.
TEST(Solver, StandardDeviationsAreThoseOfRepeatedTrials) {
  constexpr int kTrials = 120;
  for (const LensCase& each : lens_cases()) {
    const std::vector<Pose> poses = virtual_views(each.camera, kSampleBoard, 9, 11);
    const int n = each.lens.parameters();
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(n);
    Eigen::VectorXd squares = Eigen::VectorXd::Zero(n);
    Eigen::VectorXd predicted = Eigen::VectorXd::Zero(n);
    for (int trial = 0; trial < kTrials; ++trial) {
      const auto views = exact_views(
          each.camera, kSampleBoard, poses, 0.2, 100 + static_cast<std::uint64_t>(trial));
      const Solution solution = solved(views, each.lens);
      EXPECT_NEAR(solution.sigma_px, 0.2, 0.03);
      const Eigen::VectorXd error =
          parameters_of(solution.camera, each.lens) - parameters_of(each.camera, each.lens);
      sum += error;
      squares += error.cwiseAbs2();
      predicted += solution.sigma_px * solution.unit_covariance.diagonal().cwiseSqrt() / kTrials;
    }
    for (int i = 0; i < n; ++i) {
      const double mean = sum[i] / kTrials;
      const double spread = std::sqrt(squares[i] / kTrials - mean * mean);
      EXPECT_NEAR(spread / predicted[i], 1.0, 0.26) << "parameter " << i;  // 4 sigma
      EXPECT_LT(std::abs(mean), 4.0 * predicted[i] / std::sqrt(kTrials)) << "parameter " << i;
    }
  }
}

struct CvPoints {
  std::vector<std::vector<cv::Point3f>> board;
  std::vector<std::vector<cv::Point2f>> image;
};

/// Corners rounded to floats, which is all that OpenCV takes.
CvPoints cv_points(std::vector<BoardView>& views) {
  CvPoints points;
  for (BoardView& view : views) {
    std::vector<cv::Point3f>& board = points.board.emplace_back();
    std::vector<cv::Point2f>& image = points.image.emplace_back();
    for (BoardCorner& corner : view.corners) {
      const Eigen::Vector2f at_m = kSampleBoard.corner_m(corner.id).cast<float>();
      const Eigen::Vector2f pixel = corner.pixel.cast<float>();
      corner.pixel = pixel.cast<double>();
      board.emplace_back(at_m.x(), at_m.y(), 0.0F);
      image.emplace_back(pixel.x(), pixel.y());
    }
  }
  return points;
}

const cv::TermCriteria kCvEnd(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 200, 1e-14);

TEST(Solver, AgreesWithCalibrateCameraOfOpenCv) {
  const LensChoice lens{DistortionModel::kRadtan, false};
  std::vector<BoardView> views = exact_views(
      radtan_camera(), kSampleBoard, virtual_views(radtan_camera(), kSampleBoard, 12, 21), 0.25);
  const CvPoints points = cv_points(views);
  cv::Mat K;
  cv::Mat d;
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  cv::Mat deviations;
  const double rms = cv::calibrateCamera(points.board,
                                         points.image,
                                         cv::Size(640, 480),
                                         K,
                                         d,
                                         rotations,
                                         translations,
                                         deviations,
                                         cv::noArray(),
                                         cv::noArray(),
                                         cv::CALIB_FIX_K3,
                                         kCvEnd);
  const Solution ours = solved(views, lens);
  // Both are minima of the same sum; OpenCV stops at a relative step of 1e-14 in float input.
  EXPECT_NEAR(ours.rms_px, rms, 1e-6);
  const CameraModel theirs(
      PinholeCamera{
          640, 480, K.at<double>(0, 0), K.at<double>(1, 1), K.at<double>(0, 2), K.at<double>(1, 2)},
      {DistortionModel::kRadtan,
       {d.at<double>(0), d.at<double>(1), d.at<double>(2), d.at<double>(3), 0.0}});
  expect_camera(ours.camera, theirs, 2e-3, 1e-5);
  // OpenCV divides the squares by the number of corners less the unknowns, which overestimates the
  // variance of a coordinate.
  const double corners = 12.0 * kSampleBoard.corner_count();
  const double unknowns = 8.0 + 6.0 * 12.0;
  const double excess = std::sqrt((2.0 * corners - unknowns) / (corners - unknowns));
  for (int i = 0; i < lens.parameters(); ++i) {
    const double deviation = ours.sigma_px * std::sqrt(ours.unit_covariance(i, i));
    EXPECT_NEAR(deviations.at<double>(i) / deviation, excess, 0.01) << i;
  }
}

TEST(Solver, AgreesWithFisheyeCalibrateOfOpenCv) {
  const LensChoice lens{DistortionModel::kEquidistant, false};
  const CameraModel truth = equidistant_camera();
  std::vector<BoardView> views =
      exact_views(truth, kSampleBoard, virtual_views(truth, kSampleBoard, 12, 21), 0.25);
  const CvPoints points = cv_points(views);
  const PinholeCamera& c = truth.pinhole();
  cv::Mat K = (cv::Mat_<double>(3, 3) << c.fx_px, 0, c.cx_px, 0, c.fy_px, c.cy_px, 0, 0, 1);
  cv::Mat d = cv::Mat::zeros(4, 1, CV_64F);
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  const int flags = cv::fisheye::CALIB_USE_INTRINSIC_GUESS |
                    cv::fisheye::CALIB_RECOMPUTE_EXTRINSIC | cv::fisheye::CALIB_FIX_SKEW;
  cv::fisheye::calibrate(
      points.board, points.image, cv::Size(640, 480), K, d, rotations, translations, flags, kCvEnd);
  const Solution ours = solved(views, lens);
  const CameraModel theirs(
      PinholeCamera{
          640, 480, K.at<double>(0, 0), K.at<double>(1, 1), K.at<double>(0, 2), K.at<double>(1, 2)},
      {DistortionModel::kEquidistant,
       {d.at<double>(0), d.at<double>(1), d.at<double>(2), d.at<double>(3), 0.0}});
  expect_camera(ours.camera, theirs, 2e-2, 1e-3);
}

}  // namespace
}  // namespace overfly::calibration
