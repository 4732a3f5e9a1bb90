#include "core/motion/pose_covariance.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <string>

namespace overfly {
namespace {

/// Of a rounding to single precision, with a margin.
constexpr double kTolerance = 1e-6;
/// The square of the farthest coordinate of a pose.
constexpr double kLargest = 1e24;
/// Of a matrix of correlations: a smaller pivot makes its inverse meaningless.
constexpr double kSmallestPivot = 1e-10;
constexpr int kPositionSize = 3;
constexpr int kPoseSize = 6;

Error bad(const std::string& what) { return {ErrorCode::kInvalidArgument, what}; }

/// "(3, 1)": row and column from 1.
std::string place_of(int row, int column) {
  return "(" + std::to_string(row + 1) + ", " + std::to_string(column + 1) + ")";
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return matrix;
}

double inverse_deviation(double variance) {
  return variance > 0.0 ? 1.0 / std::sqrt(variance) : 0.0;
}

/// The error in standard deviations: with the correlations C = D^-1/2 P D^-1/2 = L L^T, whose
/// factor does not suffer from the different units, it is L^-1 D^-1/2 e.
std::optional<double> squared_norm(const Eigen::VectorXd& error,
                                   const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd scale = covariance.diagonal().unaryExpr(&inverse_deviation);
  const Eigen::MatrixXd correlations = scale.asDiagonal() * covariance * scale.asDiagonal();
  const Eigen::LLT<Eigen::MatrixXd> factor(correlations);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const auto L = factor.matrixL();
  if (factor.matrixLLT().diagonal().array().square().minCoeff() < kSmallestPivot)
    return std::nullopt;
  const double squared = L.solve(scale.cwiseProduct(error)).squaredNorm();
  return std::isfinite(squared) ? std::optional<double>(squared) : std::nullopt;
}

Status check_values(std::span<const double> values, int size) {
  for (int i = 0; i < static_cast<int>(values.size()); ++i) {
    const double value = values[static_cast<std::size_t>(i)];
    if (std::isfinite(value) && std::abs(value) <= kLargest) continue;
    return bad("value " + place_of(i / size, i % size) + " = " + std::to_string(value) +
               ": must be finite and at most 1e24");
  }
  return {};
}

Status check_symmetry(const Eigen::MatrixXd& P) {
  for (int row = 0; row < P.rows(); ++row) {
    for (int column = 0; column < row; ++column) {
      const double largest = std::sqrt(std::abs(P(row, row) * P(column, column)));
      if (std::abs(P(row, column) - P(column, row)) <= kTolerance * largest) continue;
      return bad("values " + place_of(row, column) + " = " + std::to_string(P(row, column)) +
                 " and " + place_of(column, row) + " = " + std::to_string(P(column, row)) +
                 ": must be equal, as the matrix is symmetric");
    }
  }
  return {};
}

/// P + tolerance has a Cholesky factorisation if no eigenvalue is below -tolerance.
Status check_definiteness(const Eigen::MatrixXd& P) {
  for (int i = 0; i < P.rows(); ++i) {
    if (P(i, i) >= 0.0) continue;
    return bad("variance " + place_of(i, i) + " = " + std::to_string(P(i, i)) +
               ": must not be negative");
  }
  const Eigen::VectorXd scale = P.diagonal().unaryExpr(&inverse_deviation);
  Eigen::MatrixXd correlations = scale.asDiagonal() * P * scale.asDiagonal();
  for (int row = 0; row < P.rows(); ++row) {
    // Without a variance there is no covariance: the check of the symmetry has ensured that the two
    // values are equal, but not that they are 0.
    if (scale[row] == 0.0 && !P.row(row).isZero(0.0)) {
      return bad("variance " + place_of(row, row) + " = 0: the other values of its row must be 0");
    }
  }
  correlations.diagonal().array() += kTolerance;
  if (Eigen::LLT<Eigen::MatrixXd>(correlations).info() == Eigen::Success) return {};
  return bad(
      "a combination of its errors has a negative variance: it must be positive "
      "semi-definite");
}

}  // namespace

Result<PoseCovariance> pose_covariance_from(std::span<const double> row_major) {
  const bool whole = row_major.size() == kPoseSize * kPoseSize;
  if (!whole && row_major.size() != kPositionSize * kPositionSize) {
    return bad(std::to_string(row_major.size()) + " values: must be 9 (position) or 36 (pose)");
  }
  const int size = whole ? kPoseSize : kPositionSize;
  if (Status status = check_values(row_major, size); !status) return status.error();
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::MatrixXd P = Eigen::Map<const RowMajor>(row_major.data(), size, size);
  if (Status status = check_symmetry(P); !status) return status.error();
  P = (0.5 * (P + P.transpose())).eval();
  if (Status status = check_definiteness(P); !status) return status.error();
  PoseCovariance covariance;
  covariance.matrix.topLeftCorner(size, size) = P;
  covariance.has_rotation =
      whole && !covariance.matrix.bottomRightCorner<kPositionSize, kPositionSize>().isZero(0.0);
  return covariance;
}

bool is_unstated(std::span<const double> row_major) {
  return std::all_of(row_major.begin(), row_major.end(), [](double value) { return value == 0.0; });
}

std::vector<double> upper_triangle(const PoseCovariance& covariance) {
  const int size = covariance.has_rotation ? kPoseSize : kPositionSize;
  std::vector<double> upper;
  for (int row = 0; row < size; ++row) {
    for (int column = row; column < size; ++column) {
      upper.push_back(covariance.matrix(row, column));
    }
  }
  return upper;
}

std::vector<double> row_major_from_upper(const std::vector<double>& upper) {
  const std::size_t size = upper.size() == 6 ? std::size_t{3} : std::size_t{6};
  if (upper.size() != size * (size + 1) / 2) return upper;
  std::vector<double> values(size * size);
  auto next = upper.begin();
  for (std::size_t row = 0; row < size; ++row) {
    for (std::size_t column = row; column < size; ++column) {
      values[row * size + column] = values[column * size + row] = *next++;
    }
  }
  return values;
}

Matrix6d in_target(const Similarity& S_target_vo, const Matrix6d& covariance) {
  const Eigen::Matrix3d R = S_target_vo.rotation.toRotationMatrix();
  Matrix6d J = Matrix6d::Zero();
  J.topLeftCorner<3, 3>() = S_target_vo.scale * R;
  J.bottomRightCorner<3, 3>() = R;
  return J * covariance * J.transpose();
}

Matrix6d inverted_covariance(const Pose& T_a_b, const Matrix6d& covariance) {
  // p_b = -R_b_a p_a. With p_a + d and exp(theta) R_a_b: R_b_a exp(-theta) = exp(-R_b_a theta)
  // R_b_a, and the position changes by -R_b_a d + R_b_a (theta x p_a).
  const Eigen::Matrix3d R_b_a = T_a_b.rotation.toRotationMatrix().transpose();
  Matrix6d J = Matrix6d::Zero();
  J.topLeftCorner<3, 3>() = -R_b_a;
  J.topRightCorner<3, 3>() = -R_b_a * cross_matrix(T_a_b.translation);
  J.bottomRightCorner<3, 3>() = -R_b_a;
  return J * covariance * J.transpose();
}

std::optional<double> squared_deviation(const Eigen::Vector3d& error,
                                        const Eigen::Matrix3d& covariance) {
  return squared_norm(error, covariance);
}

std::optional<double> squared_deviation(const Vector6d& error, const Matrix6d& covariance) {
  return squared_norm(error, covariance);
}

}  // namespace overfly
