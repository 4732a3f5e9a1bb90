// Decompositions of small dense matrices. They are compiled once, here, because Eigen's templates
// for them take seconds in every file that uses them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <optional>

namespace overfly {

using Matrix9d = Eigen::Matrix<double, 9, 9>;
using Vector9d = Eigen::Matrix<double, 9, 1>;

/// A = vectors * diag(values) * vectors^T of a symmetric N x N matrix; values ascending, vectors
/// orthonormal, one in each column.
template <int N>
struct SymmetricEigen {
  Eigen::Matrix<double, N, 1> values;
  Eigen::Matrix<double, N, N> vectors;
};

/// Reads the lower triangle. Values that are not finite give undefined results.
[[nodiscard]] SymmetricEigen<3> symmetric_eigen(const Eigen::Matrix3d& A);
[[nodiscard]] SymmetricEigen<9> symmetric_eigen(const Matrix9d& A);
/// Empty if the iteration does not converge.
[[nodiscard]] std::optional<SymmetricEigen<Eigen::Dynamic>> symmetric_eigen(
    const Eigen::MatrixXd& A);

/// A = U * diag(values) * V^T; U and V orthogonal, values descending and at least 0.
struct Svd3 {
  Eigen::Matrix3d U;
  Eigen::Vector3d values;
  Eigen::Matrix3d V;
};

[[nodiscard]] Svd3 svd(const Eigen::Matrix3d& A);

/// Singular values of a 2 x 2 matrix, descending, in closed form.
[[nodiscard]] Eigen::Vector2d singular_values(const Eigen::Matrix2d& A);

/// Eigenvalues in no particular order; complex ones in neighbouring conjugate pairs.
[[nodiscard]] std::array<std::complex<double>, 4> eigenvalues(const Eigen::Matrix4d& A);

}  // namespace overfly
