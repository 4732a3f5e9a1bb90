#include "core/algebra/decompositions.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <cmath>
#include <cstddef>

namespace overfly {

SymmetricEigen<3> symmetric_eigen(const Eigen::Matrix3d& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

// With the solver for any size: one more solver takes the compiler 7 s.
SymmetricEigen<9> symmetric_eigen(const Matrix9d& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

std::optional<SymmetricEigen<Eigen::Dynamic>> symmetric_eigen(const Eigen::MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A);
  if (solver.info() != Eigen::Success) return std::nullopt;
  return SymmetricEigen<Eigen::Dynamic>{solver.eigenvalues(), solver.eigenvectors()};
}

Svd3 svd(const Eigen::Matrix3d& A) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> solver(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {solver.matrixU(), solver.singularValues(), solver.matrixV()};
}

Eigen::Vector2d singular_values(const Eigen::Matrix2d& A) {
  // A is the sum of a scaled rotation and a scaled reflection; the singular values are the sum and
  // the difference of the two scales.
  const double rotation = 0.5 * std::hypot(A(0, 0) + A(1, 1), A(1, 0) - A(0, 1));
  const double reflection = 0.5 * std::hypot(A(0, 0) - A(1, 1), A(1, 0) + A(0, 1));
  return {rotation + reflection, std::abs(rotation - reflection)};
}

std::array<std::complex<double>, 4> eigenvalues(const Eigen::Matrix4d& A) {
  const Eigen::EigenSolver<Eigen::Matrix4d> solver(A, false);
  std::array<std::complex<double>, 4> values;
  for (std::size_t i = 0; i < 4; ++i) {
    values[i] = solver.eigenvalues()(static_cast<Eigen::Index>(i));
  }
  return values;
}

}  // namespace overfly
