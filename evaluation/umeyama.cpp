#include "evaluation/umeyama.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "core/algebra/decompositions.hpp"

namespace overfly::evaluation {
namespace {

/// If the ratio of the second to the first singular value is below this limit, the least squares
/// determine the rotation about the line only up to rounding errors.
constexpr double kLineRatio = 1e-10;
/// Motion below this fraction of the distance from the origin counts as rounding error.
constexpr double kRounding = 1e-12;

/// Moments of x (vo) and y (world) about the mean or the first position.
struct Moments {
  Eigen::Vector3d centre_x = Eigen::Vector3d::Zero();
  Eigen::Vector3d centre_y = Eigen::Vector3d::Zero();
  double variance_x = 0.0;
  double variance_y = 0.0;
  Eigen::Matrix3d sigma_xy = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d sigma_yy = Eigen::Matrix3d::Zero();
  bool x_moves = false;
  bool y_moves = false;
};

Moments moments_of(const std::vector<MatchedPose>& matches, bool about_first) {
  const double n = static_cast<double>(matches.size());
  Moments m;
  if (about_first) {
    m.centre_x = matches.front().T_vo_camera.translation;
    m.centre_y = matches.front().T_world_camera.translation;
  } else {
    for (const MatchedPose& match : matches) {
      m.centre_x += match.T_vo_camera.translation / n;     // (34)
      m.centre_y += match.T_world_camera.translation / n;  // (35)
    }
  }
  double size_x = 0.0;
  double size_y = 0.0;
  for (const MatchedPose& match : matches) {
    const Eigen::Vector3d x = match.T_vo_camera.translation - m.centre_x;
    const Eigen::Vector3d y = match.T_world_camera.translation - m.centre_y;
    m.variance_x += x.squaredNorm() / n;  // (36)
    m.variance_y += y.squaredNorm() / n;  // (37)
    m.sigma_xy += y * x.transpose() / n;  // (38), 3x3
    m.sigma_yy += y * y.transpose() / n;
    size_x = std::max(size_x, match.T_vo_camera.translation.norm());
    size_y = std::max(size_y, match.T_world_camera.translation.norm());
  }
  m.x_moves = std::sqrt(m.variance_x) > kRounding * size_x;
  m.y_moves = std::sqrt(m.variance_y) > kRounding * size_y;
  return m;
}

Status check_motion(const std::vector<MatchedPose>& matches, const Moments& m, bool with_scale) {
  const char* const undetermined = with_scale ? "scale and rotation" : "the rotation";
  if (m.x_moves && m.y_moves) return {};
  return Error{ErrorCode::kInvalidArgument,
               std::string(m.x_moves ? "the truth" : "the estimate") + " does not move over its " +
                   std::to_string(matches.size()) + " poses: " + undetermined +
                   " cannot be determined"};
}

/// Rotation R(angle about `axis`) * R that best aligns the orientations: maximises sum
/// tr(R_world_camera^T R(angle) R R_vo_camera) = c + A cos(angle) + B sin(angle).
Eigen::Matrix3d turned_to_orientations(const std::vector<MatchedPose>& matches,
                                       const Eigen::Matrix3d& R,
                                       const Eigen::Vector3d& axis) {
  Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
  for (const MatchedPose& match : matches) {
    M += R * match.T_vo_camera.rotation.toRotationMatrix() *
         match.T_world_camera.rotation.toRotationMatrix().transpose();
  }
  // tr([axis]x M) written out.
  const Eigen::Vector3d antisymmetric(M(1, 2) - M(2, 1), M(2, 0) - M(0, 2), M(0, 1) - M(1, 0));
  const double angle_rad = std::atan2(axis.dot(antisymmetric), M.trace() - axis.dot(M * axis));
  return Eigen::AngleAxisd(angle_rad, axis).toRotationMatrix() * R;
}

/// Ratio of the second to the first singular value: of the covariance of truth and estimate, or of
/// the truth if that is smaller (lateral errors of an estimate must not hide that the truth
/// is straight).
double straightness(const Moments& m, const Eigen::Vector3d& D) {
  const Eigen::Vector3d own = m.sigma_yy.jacobiSvd().singularValues();
  return std::min(D(1) / D(0), own(1) / own(0));
}

std::string straight_text(double ratio) {
  char text[200];
  std::snprintf(
      text,
      sizeof(text),
      "the path is nearly straight (its lateral spread is %.2g %% of its longitudinal spread): "
      "positions do not determine the rotation about it",
      100.0 * std::sqrt(std::max(0.0, ratio)));
  return text;
}

}  // namespace

Result<Similarity> fit_similarity(const std::vector<MatchedPose>& matches,
                                  const FitOptions& options,
                                  AlignmentRemarks* remarks) {
  if (matches.size() < 2) {
    return Error{ErrorCode::kInvalidArgument,
                 std::to_string(matches.size()) + " matched poses: must be at least 2"};
  }
  const Moments m = moments_of(matches, options.hold_first);
  if (Status status = check_motion(matches, m, options.with_scale); !status) return status.error();

  const Svd3 parts = svd(m.sigma_xy);  // (39)
  const Eigen::Vector3d& D = parts.values;
  if (D(0) <= kLineRatio * std::sqrt(m.variance_x * m.variance_y)) {
    return Error{ErrorCode::kInvalidArgument,
                 "the estimate's motion is not correlated with the truth's: the rotation cannot "
                 "be determined"};
  }
  Eigen::Vector3d S = Eigen::Vector3d::Ones();
  if (parts.U.determinant() * parts.V.determinant() < 0.0) S(2) = -1.0;  // (43)
  Eigen::Matrix3d R = parts.U * S.asDiagonal() * parts.V.transpose();    // (40)
  const double ratio = straightness(m, D);
  const bool nearly_straight = ratio < kStraightRatio;
  const bool on_line = D(1) <= kLineRatio * D(0);
  double correlation = D.dot(S);  // tr(D S), which is tr(R^T sigma_xy)
  if (remarks != nullptr && nearly_straight) remarks->degenerate = straight_text(ratio);
  if (on_line || (nearly_straight && options.turn_nearly_straight)) {
    R = turned_to_orientations(matches, R, parts.U.col(0));
    correlation = (R.transpose() * m.sigma_xy).trace();
    if (remarks != nullptr) {
      remarks->notes.push_back(std::string("the positions lie ") + (on_line ? "" : "nearly ") +
                               "on a line: the rotation about it is taken from the orientations");
    }
  }
  Similarity S_world_vo;
  S_world_vo.rotation = Eigen::Quaterniond(R).normalized();
  if (options.with_scale) S_world_vo.scale = correlation / m.variance_x;  // (42)
  S_world_vo.translation =
      m.centre_y - S_world_vo.scale * (S_world_vo.rotation * m.centre_x);  // (41)
  return S_world_vo;
}

Result<Similarity> fit_yaw(const std::vector<MatchedPose>& matches) {
  if (matches.size() < 2) {
    return Error{ErrorCode::kInvalidArgument,
                 std::to_string(matches.size()) + " matched poses: must be at least 2"};
  }
  const Moments m = moments_of(matches, false);
  // Maximises sum y . Rz(yaw) x = A cos(yaw) + B sin(yaw), plus the vertical part.
  const double A = m.sigma_xy(0, 0) + m.sigma_xy(1, 1);
  const double B = m.sigma_xy(1, 0) - m.sigma_xy(0, 1);
  const double spread = std::sqrt(m.variance_x * m.variance_y);
  if (!m.x_moves || !m.y_moves || std::hypot(A, B) <= kLineRatio * spread) {
    return Error{ErrorCode::kInvalidArgument,
                 "the positions do not move horizontally: yaw cannot be determined"};
  }
  Similarity S_world_vo;
  S_world_vo.rotation = Eigen::AngleAxisd(std::atan2(B, A), Eigen::Vector3d::UnitZ());
  S_world_vo.translation = m.centre_y - S_world_vo.rotation * m.centre_x;
  return S_world_vo;
}

}  // namespace overfly::evaluation
