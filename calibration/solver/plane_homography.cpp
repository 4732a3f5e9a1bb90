#include "calibration/solver/plane_homography.hpp"

#include <Eigen/LU>
#include <cmath>

#include "core/algebra/decompositions.hpp"

namespace overfly::calibration {
namespace {

/// Moves the centroid to the origin and scales the mean distance from it to sqrt(2).
std::optional<Eigen::Matrix3d> normalisation(const std::vector<PlanePair>& pairs,
                                             Eigen::Vector2d PlanePair::*point) {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (const PlanePair& pair : pairs) centre += pair.*point;
  centre /= static_cast<double>(pairs.size());
  double distance = 0.0;
  for (const PlanePair& pair : pairs) distance += (pair.*point - centre).norm();
  distance /= static_cast<double>(pairs.size());
  if (!(distance > 0.0) || !std::isfinite(distance)) return std::nullopt;
  const double scale = std::sqrt(2.0) / distance;
  Eigen::Matrix3d N;
  N << scale, 0.0, -scale * centre.x(), 0.0, scale, -scale * centre.y(), 0.0, 0.0, 1.0;
  return N;
}

}  // namespace

std::optional<Eigen::Matrix3d> homography(const std::vector<PlanePair>& pairs) {
  if (pairs.size() < 4) return std::nullopt;
  const auto N_plane = normalisation(pairs, &PlanePair::plane);
  const auto N_image = normalisation(pairs, &PlanePair::image);
  if (!N_plane || !N_image) return std::nullopt;
  Matrix9d AtA = Matrix9d::Zero();
  for (const PlanePair& pair : pairs) {
    const Eigen::Vector3d p = *N_plane * pair.plane.homogeneous();
    const Eigen::Vector3d q = *N_image * pair.image.homogeneous();
    Eigen::Matrix<double, 2, 9> rows;
    rows << Eigen::RowVector3d::Zero(), -p.transpose(), q.y() * p.transpose(), p.transpose(),
        Eigen::RowVector3d::Zero(), -q.x() * p.transpose();
    AtA += rows.transpose() * rows;
  }
  const SymmetricEigen<9> eigen = symmetric_eigen(AtA);
  // A second vanishing eigenvalue: the points do not determine H.
  if (!(eigen.values[1] > 1e-10 * eigen.values[8])) return std::nullopt;
  const Vector9d h = eigen.vectors.col(0);
  Eigen::Matrix3d H;
  H << h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], h[8];
  return Eigen::Matrix3d(N_image->inverse() * H * *N_plane);
}

std::optional<Pose> plane_pose(const Eigen::Matrix3d& H) {
  double scale = 2.0 / (H.col(0).norm() + H.col(1).norm());
  if (H(2, 2) < 0.0) scale = -scale;
  const Eigen::Vector3d t = scale * H.col(2);
  if (!t.allFinite() || !(t.z() > 0.0)) return std::nullopt;
  Eigen::Matrix3d Q;
  Q.col(0) = scale * H.col(0);
  Q.col(1) = scale * H.col(1);
  Q.col(2) = Q.col(0).cross(Q.col(1));
  const Svd3 parts = svd(Q);
  const Eigen::Matrix3d R = parts.U * parts.V.transpose();
  if (!(R.determinant() > 0.0)) return std::nullopt;
  return Pose{Eigen::Quaterniond(R).normalized(), t};
}

}  // namespace overfly::calibration
