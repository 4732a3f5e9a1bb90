// Computes motions from homographies and essential matrices.
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "core/algebra/decompositions.hpp"
#include "odometry/geometry/two_view.hpp"

namespace overfly::odometry {
namespace {

constexpr double kNoMotion = 1e-9;

Eigen::Matrix3d frame_of(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  Eigen::Matrix3d m;
  m << a, b, a.cross(b);
  return m;
}

Pose unit_motion(const Eigen::Matrix3d& R, const Eigen::Vector3d& t) {
  return {Eigen::Quaterniond(R).normalized(), t.normalized()};
}

}  // namespace

Eigen::Matrix3d essential_of_five(const std::vector<Eigen::Vector2d>& first,
                                  const std::vector<Eigen::Vector2d>& second,
                                  double threshold) {
  const auto points_of = [](const std::vector<Eigen::Vector2d>& from) {
    std::vector<cv::Point2d> points;
    points.reserve(from.size());
    for (const Eigen::Vector2d& p : from) points.emplace_back(p.x(), p.y());
    return points;
  };
  constexpr double kConfidence = 0.999;
  constexpr int kMaxRounds = 1000;
  if (first.size() < 8) return Eigen::Matrix3d::Zero();
  const cv::Mat E = cv::findEssentialMat(points_of(first),
                                         points_of(second),
                                         cv::Mat::eye(3, 3, CV_64F),
                                         cv::RANSAC,
                                         kConfidence,
                                         threshold,
                                         kMaxRounds);
  // OpenCV returns an empty matrix if no model is found, and several stacked matrices for exactly
  // five pairs.
  if (E.rows != 3 || E.cols != 3) return Eigen::Matrix3d::Zero();
  Eigen::Matrix3d result;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) result(row, column) = E.at<double>(row, column);
  }
  return result.allFinite() ? result : Eigen::Matrix3d::Zero();
}

std::vector<Pose> motions_of_homography(const Eigen::Matrix3d& H_calibrated) {
  // The second singular value of R + t n^T / d is one.
  Eigen::Matrix3d H = H_calibrated / svd(H_calibrated).values(1);
  if (H.determinant() < 0.0) H = -H;
  const SymmetricEigen<3> eigen = symmetric_eigen(Eigen::Matrix3d(H.transpose() * H));
  const double s1 = eigen.values(2);  // squares of the singular values
  const double s3 = eigen.values(0);
  if (s1 - s3 < kNoMotion) return {};
  Eigen::Matrix3d V = eigen.vectors.rowwise().reverse();
  if (V.determinant() < 0.0) V = -V;
  const double a = std::sqrt(std::max(0.0, 1.0 - s3) / (s1 - s3));
  const double b = std::sqrt(std::max(0.0, s1 - 1.0) / (s1 - s3));
  std::vector<Pose> motions;
  for (const double sign : {1.0, -1.0}) {
    const Eigen::Vector3d u = a * V.col(0) + sign * b * V.col(2);
    const Eigen::Matrix3d U = frame_of(V.col(1), u);
    const Eigen::Matrix3d W = frame_of(H * V.col(1), H * u);
    const Eigen::Matrix3d R = W * U.transpose();
    const Eigen::Vector3d t = (H - R) * U.col(2);
    if (t.norm() < kNoMotion) continue;
    motions.push_back(unit_motion(R, t));
    motions.push_back(unit_motion(R, -t));
  }
  return motions;
}

std::vector<Pose> motions_of_essential(const Eigen::Matrix3d& E) {
  auto [U, values, V] = svd(E);
  if (U.determinant() < 0.0) U = -U;
  if (V.determinant() < 0.0) V = -V;
  Eigen::Matrix3d W;
  W << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  const Eigen::Matrix3d R1 = U * W * V.transpose();
  const Eigen::Matrix3d R2 = U * W.transpose() * V.transpose();
  const Eigen::Vector3d t = U.col(2);
  return {unit_motion(R1, t), unit_motion(R1, -t), unit_motion(R2, t), unit_motion(R2, -t)};
}

}  // namespace overfly::odometry
