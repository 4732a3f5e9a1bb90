#include "core/algebra/decompositions.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>

namespace overfly {
namespace {

constexpr double kTolerance = 1e-12;  // of numbers of size 1, after a few hundred operations

template <int N>
Eigen::Matrix<double, N, N> random_matrix(std::mt19937_64& generator) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Eigen::Matrix<double, N, N> A;
  for (double& value : A.reshaped()) value = uniform(generator);
  return A;
}

template <typename Matrix, typename Eigen_>
void expect_decomposed(const Matrix& A, const Eigen_& eigen) {
  const Matrix product = eigen.vectors * eigen.values.asDiagonal() * eigen.vectors.transpose();
  EXPECT_LT((product - A).norm(), kTolerance);
  EXPECT_LT(
      (eigen.vectors.transpose() * eigen.vectors - Matrix::Identity(A.rows(), A.cols())).norm(),
      kTolerance);
  EXPECT_TRUE(std::is_sorted(eigen.values.begin(), eigen.values.end()));
}

TEST(Decompositions, SymmetricEigenGivesTheMatrixBack) {
  std::mt19937_64 generator(1);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Matrix3d three = random_matrix<3>(generator);
    const Eigen::Matrix3d A = three + three.transpose();
    expect_decomposed(A, symmetric_eigen(A));
    const Matrix9d nine = random_matrix<9>(generator);
    const Matrix9d B = nine * nine.transpose();
    expect_decomposed(B, symmetric_eigen(B));
    const auto dynamic = symmetric_eigen(Eigen::MatrixXd(B));
    ASSERT_TRUE(dynamic);
    expect_decomposed(Eigen::MatrixXd(B), *dynamic);
  }
}

TEST(Decompositions, SvdGivesTheMatrixBack) {
  std::mt19937_64 generator(2);
  for (int i = 0; i < 20; ++i) {
    Eigen::Matrix3d A = random_matrix<3>(generator);
    if (i % 3 == 0) A.col(2) = A.col(0) - A.col(1);  // rank 2
    const Svd3 s = svd(A);
    EXPECT_LT((s.U * s.values.asDiagonal() * s.V.transpose() - A).norm(), kTolerance);
    EXPECT_LT((s.U * s.U.transpose() - Eigen::Matrix3d::Identity()).norm(), kTolerance);
    EXPECT_LT((s.V * s.V.transpose() - Eigen::Matrix3d::Identity()).norm(), kTolerance);
    EXPECT_TRUE(s.values[0] >= s.values[1] && s.values[1] >= s.values[2] && s.values[2] >= 0.0);
  }
}

TEST(Decompositions, SingularValuesOfTwoByTwo) {
  std::mt19937_64 generator(3);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Matrix2d A = random_matrix<2>(generator);
    const Eigen::Vector2d s = singular_values(A);
    EXPECT_NEAR(s[0] * s[1], std::abs(A.determinant()), kTolerance);
    EXPECT_NEAR(s.squaredNorm(), A.squaredNorm(), kTolerance);
    EXPECT_GE(s[0], s[1]);
  }
  EXPECT_EQ(singular_values(Eigen::Matrix2d::Zero()), Eigen::Vector2d::Zero());
}

TEST(Decompositions, EigenvaluesAreRootsOfTheCharacteristicPolynomial) {
  // Block diagonal: a damped oscillation -1 +- 2i, and 3 and -4.
  Eigen::Matrix4d A;
  A << -1, 2, 0.5, 1, -2, -1, 0.25, 2, 0, 0, 3, 7, 0, 0, 0, -4;
  auto values = eigenvalues(A);
  std::sort(values.begin(), values.end(), [](const auto& a, const auto& b) {
    return a.real() != b.real() ? a.real() < b.real() : a.imag() < b.imag();
  });
  EXPECT_LT(std::abs(values[0] - std::complex<double>(-4.0, 0.0)), kTolerance);
  EXPECT_LT(std::abs(values[1] - std::complex<double>(-1.0, -2.0)), kTolerance);
  EXPECT_LT(std::abs(values[2] - std::complex<double>(-1.0, 2.0)), kTolerance);
  EXPECT_LT(std::abs(values[3] - std::complex<double>(3.0, 0.0)), kTolerance);
}

}  // namespace
}  // namespace overfly
