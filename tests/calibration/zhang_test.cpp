// The guess and the solver against Zhang's closed form, written here from the paper.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

#include "calibration/solver/first_guess.hpp"
#include "calibration/solver/plane_homography.hpp"
#include "calibration/solver/solve.hpp"
#include "calibration/virtual/virtual_views.hpp"
#include "tests/calibration/sample_views.hpp"

namespace overfly::calibration {
namespace {

Eigen::Matrix3d homography_of(const BoardView& view) {
  std::vector<PlanePair> pairs;
  for (const BoardCorner& corner : view.corners) {
    pairs.push_back({kSampleBoard.corner_m(corner.id), corner.pixel});
  }
  return homography(pairs).value();
}

/// v_ij of Zhang 2000 ("A flexible new technique for camera calibration", IEEE PAMI 22(11)), below
/// equation 7; h_i is the i-th column of H.
Eigen::Matrix<double, 6, 1> v(const Eigen::Matrix3d& H, int i, int j) {
  Eigen::Matrix<double, 6, 1> row;
  row << H(0, i) * H(0, j), H(0, i) * H(1, j) + H(1, i) * H(0, j), H(1, i) * H(1, j),
      H(2, i) * H(0, j) + H(0, i) * H(2, j), H(2, i) * H(1, j) + H(1, i) * H(2, j),
      H(2, i) * H(2, j);
  return row;
}

/// Appendix B of the paper.
PinholeCamera zhang(const std::vector<BoardView>& views) {
  Eigen::MatrixXd V(2 * static_cast<Eigen::Index>(views.size()), 6);
  Eigen::Index row = 0;
  for (const BoardView& view : views) {
    const Eigen::Matrix3d H = homography_of(view);
    V.row(row++) = v(H, 0, 1).transpose();
    V.row(row++) = (v(H, 0, 0) - v(H, 1, 1)).transpose();
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(V, Eigen::ComputeFullV);
  const Eigen::VectorXd b = svd.matrixV().col(5);
  const double B11 = b[0], B12 = b[1], B22 = b[2], B13 = b[3], B23 = b[4], B33 = b[5];
  const double v0 = (B12 * B13 - B11 * B23) / (B11 * B22 - B12 * B12);
  const double lambda = B33 - (B13 * B13 + v0 * (B12 * B13 - B11 * B23)) / B11;
  const double alpha = std::sqrt(lambda / B11);
  const double beta = std::sqrt(lambda * B11 / (B11 * B22 - B12 * B12));
  const double gamma = -B12 * alpha * alpha * beta / lambda;
  const double u0 = gamma * v0 / beta - B13 * alpha * alpha / lambda;
  return {640, 480, alpha, beta, u0, v0};
}

TEST(Zhang, ClosedFormAndSolverGiveTheCameraOfExactCorners) {
  const CameraModel camera = pinhole_camera();
  const auto views = exact_views(camera, kSampleBoard, virtual_views(camera, kSampleBoard, 6, 9));
  const PinholeCamera closed = zhang(views);
  EXPECT_NEAR(closed.fx_px, camera.pinhole().fx_px, 1e-4);
  EXPECT_NEAR(closed.cy_px, camera.pinhole().cy_px, 1e-4);
  const LensChoice lens{DistortionModel::kNone, false};
  const auto guess = first_guess(kSampleBoard, closed, lens, views);
  ASSERT_TRUE(guess.has_value());
  // The principal point of the guess is the image's centre, so its focal length is rough.
  EXPECT_NEAR(guess->camera.pinhole().fx_px / closed.fx_px, 1.0, 0.1);
  const auto solution = solve(kSampleBoard, lens, views, *guess);
  ASSERT_TRUE(solution.ok());
  EXPECT_NEAR(solution->camera.pinhole().fx_px, closed.fx_px, 1e-4);
  EXPECT_NEAR(solution->camera.pinhole().fy_px, closed.fy_px, 1e-4);
  EXPECT_NEAR(solution->camera.pinhole().cx_px, closed.cx_px, 1e-4);
  EXPECT_NEAR(solution->camera.pinhole().cy_px, closed.cy_px, 1e-4);
}

TEST(Zhang, SolverIsCloserToTheTruthThanTheClosedFormWithNoise) {
  const CameraModel camera = pinhole_camera();
  const auto views =
      exact_views(camera, kSampleBoard, virtual_views(camera, kSampleBoard, 12, 9), 0.3);
  const PinholeCamera closed = zhang(views);
  const LensChoice lens{DistortionModel::kNone, false};
  const auto solution =
      solve(kSampleBoard, lens, views, first_guess(kSampleBoard, closed, lens, views).value());
  ASSERT_TRUE(solution.ok());
  const double f = camera.pinhole().fx_px;
  EXPECT_NEAR(closed.fx_px, f, 0.02 * f);
  EXPECT_LT(std::abs(solution->camera.pinhole().fx_px - f), std::abs(closed.fx_px - f));
}

TEST(PlaneHomography, RefusesPointsOnALine) {
  std::vector<PlanePair> pairs;
  for (int i = 0; i < 8; ++i) pairs.push_back({{0.1 * i, 0.2 * i}, {10.0 * i, 5.0 * i}});
  EXPECT_FALSE(homography(pairs).has_value());
  EXPECT_FALSE(homography({}).has_value());
}

}  // namespace
}  // namespace overfly::calibration
