#include "core/motion/pose_covariance.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace overfly {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A covariance with all its correlations: A A^T.
Matrix6d some_covariance() {
  Matrix6d A;
  for (int i = 0; i < 36; ++i) A(i / 6, i % 6) = std::sin(1.0 + 2.0 * i) + (i % 7 == 0 ? 3.0 : 0.0);
  return A * A.transpose();
}

std::vector<double> values_of(const Eigen::MatrixXd& matrix) {
  std::vector<double> values;
  for (int row = 0; row < matrix.rows(); ++row) {
    for (int column = 0; column < matrix.cols(); ++column) values.push_back(matrix(row, column));
  }
  return values;
}

std::string fault_of_values(const std::vector<double>& values) {
  const auto covariance = pose_covariance_from(values);
  return covariance ? "" : covariance.error().message;
}

TEST(PoseCovariance, IsTakenAsRowsOfThePoseOrOfThePosition) {
  const Matrix6d P = some_covariance();
  const auto whole = pose_covariance_from(values_of(P));
  ASSERT_TRUE(whole.ok()) << whole.error().message;
  EXPECT_TRUE(whole->has_rotation);
  EXPECT_TRUE(whole->matrix.isApprox(P, 1e-15));
  const auto position = pose_covariance_from(values_of(P.topLeftCorner<3, 3>()));
  ASSERT_TRUE(position.ok()) << position.error().message;
  EXPECT_FALSE(position->has_rotation);
  EXPECT_TRUE((position->matrix.topLeftCorner<3, 3>().isApprox(P.topLeftCorner<3, 3>())));
  EXPECT_TRUE((position->matrix.bottomRightCorner<3, 3>().isZero(0.0)));
  Matrix6d no_rotation = Matrix6d::Zero();
  no_rotation.topLeftCorner<3, 3>() = P.topLeftCorner<3, 3>();
  EXPECT_FALSE(pose_covariance_from(values_of(no_rotation))->has_rotation);
}

TEST(PoseCovariance, RejectsWhatIsNone) {
  const auto changed = [](int row, int column, double value) {
    Matrix6d P = some_covariance();
    P(row, column) = value;
    return fault_of_values(values_of(P));
  };
  EXPECT_EQ(changed(0, 0, some_covariance()(0, 0)), "");
  EXPECT_THAT(changed(1, 2, kNan), HasSubstr("value (2, 3) = nan: must be finite"));
  EXPECT_THAT(changed(5, 5, 1e25), HasSubstr("value (6, 6)"));
  EXPECT_THAT(changed(0, 3, some_covariance()(0, 3) + 0.01), HasSubstr("values (4, 1) = "));
  EXPECT_THAT(changed(4, 4, -0.5), HasSubstr("variance (5, 5) = -0.5"));
  Eigen::Matrix3d negative = Eigen::Matrix3d::Identity();
  negative(1, 1) = -1.0;
  EXPECT_THAT(fault_of_values(values_of(negative)), HasSubstr("variance (2, 2) = -1.0"));
  // Each pair of errors may have this correlation, all three of them cannot.
  Eigen::Matrix3d impossible = Eigen::Matrix3d::Constant(-0.9);
  impossible.diagonal().setOnes();
  EXPECT_THAT(fault_of_values(values_of(impossible)), HasSubstr("negative variance"));
  EXPECT_THAT(fault_of_values({1.0, 2.0}), HasSubstr("2 values: must be 9 (position) or 36"));
}

TEST(PoseCovariance, ToleratesRoundingAndSingularMatrices) {
  Matrix6d rounded = some_covariance().cast<float>().cast<double>();
  rounded(2, 4) = std::nextafter(static_cast<float>(rounded(2, 4)), 1e9F);
  EXPECT_EQ(fault_of_values(values_of(rounded)), "");
  EXPECT_TRUE(
      pose_covariance_from(values_of(rounded))
          ->matrix.isApprox(pose_covariance_from(values_of(rounded))->matrix.transpose(), 0.0));
  // One axis is known exactly, two others have the same error: metres and radians differ a lot.
  Matrix6d singular = Matrix6d::Zero();
  singular.diagonal() << 1e4, 1e4, 0.0, 1e-12, 1e-12, 1e-12;
  singular(0, 1) = singular(1, 0) = 1e4;
  EXPECT_EQ(fault_of_values(values_of(singular)), "");
}

TEST(PoseCovariance, IsUnstatedIfEveryValueIsZero) {
  EXPECT_TRUE(is_unstated(std::vector<double>(36, 0.0)));
  EXPECT_TRUE(is_unstated(std::vector<double>()));
  EXPECT_FALSE(is_unstated(values_of(some_covariance())));
}

TEST(PoseCovariance, TriangleIsWrittenAndReadBack) {
  const PoseCovariance whole = pose_covariance_from(values_of(some_covariance())).value();
  const std::vector<double> upper = upper_triangle(whole);
  EXPECT_EQ(upper.size(), 21U);
  EXPECT_EQ(pose_covariance_from(row_major_from_upper(upper))->matrix, whole.matrix);
  const auto position = pose_covariance_from(std::vector<double>{4, 1, 0, 1, 5, 2, 0, 2, 6});
  ASSERT_TRUE(position.ok()) << position.error().message;
  EXPECT_THAT(upper_triangle(*position), ElementsAre(4, 1, 0, 5, 2, 6));
  EXPECT_EQ(pose_covariance_from(row_major_from_upper({4, 1, 0, 5, 2, 6}))->matrix,
            position->matrix);
  EXPECT_THAT(fault_of_values(row_major_from_upper({1.0, 2.0, 3.0})), HasSubstr("3 values"));
}

/// exp(theta) R, p + d.
Pose disturbed(const Pose& T, const Vector6d& error) {
  const Eigen::Vector3d theta = error.tail<3>();
  const Eigen::Quaterniond turn(theta.isZero()
                                    ? Eigen::AngleAxisd(0.0, Eigen::Vector3d::UnitX())
                                    : Eigen::AngleAxisd(theta.norm(), theta.normalized()));
  return {turn * T.rotation, T.translation + error.head<3>()};
}

/// The error of an estimate by its definition.
Vector6d error_between(const Pose& true_pose, const Pose& estimate) {
  const Eigen::AngleAxisd turn(true_pose.rotation * estimate.rotation.conjugate());
  Vector6d error;
  error << true_pose.translation - estimate.translation, turn.axis() * turn.angle();
  return error;
}

Pose some_pose() {
  return {Eigen::Quaterniond(0.4, -0.2, 0.7, 0.5).normalized(), {12.0, -7.0, 3.0}};
}

/// Against small errors that are carried through the transformation one by one: J P J^T with J by
/// finite differences.
template <typename Map>
Matrix6d carried(const Matrix6d& covariance, const Map& map) {
  constexpr double kStep = 1e-6;
  Matrix6d J;
  for (int i = 0; i < 6; ++i) {
    const Vector6d step = kStep * Vector6d::Unit(i);
    J.col(i) = error_between(map(disturbed(some_pose(), step)), map(some_pose())) / kStep;
  }
  return J * covariance * J.transpose();
}

TEST(PoseCovariance, MovesWithAnAlignment) {
  const Similarity S{273.0, Eigen::Quaterniond(0.3, -0.7, 0.2, 0.6).normalized(), {9.0, 8.0, 7.0}};
  const Matrix6d expected =
      carried(some_covariance(), [&](const Pose& T_vo_camera) { return S * T_vo_camera; });
  EXPECT_TRUE(in_target(S, some_covariance()).isApprox(expected, 1e-5))
      << in_target(S, some_covariance()) << "\n\n"
      << expected;
}

TEST(PoseCovariance, MovesWithTheInverseOfThePose) {
  const Matrix6d expected =
      carried(some_covariance(), [](const Pose& T_a_b) { return T_a_b.inverse(); });
  EXPECT_TRUE(inverted_covariance(some_pose(), some_covariance()).isApprox(expected, 1e-5))
      << inverted_covariance(some_pose(), some_covariance()) << "\n\n"
      << expected;
}

Eigen::Matrix3d diagonal(double xx, double yy, double zz) {
  return Eigen::Vector3d(xx, yy, zz).asDiagonal();
}

TEST(PoseCovariance, SquaredDeviationsAreThoseOfTheInverse) {
  const Matrix6d P = some_covariance();
  Vector6d error;
  error << 1.0, -2.0, 0.5, 0.1, 0.2, -0.3;
  const auto squared = squared_deviation(error, P);
  ASSERT_TRUE(squared);
  EXPECT_NEAR(*squared, error.dot(P.inverse() * error), 1e-9 * *squared);
  EXPECT_DOUBLE_EQ(*squared_deviation(Eigen::Vector3d(2.0, 3.0, 0.1), diagonal(4.0, 9.0, 0.01)),
                   3.0);
  EXPECT_FALSE(squared_deviation(Eigen::Vector3d(1.0, 1.0, 1.0), diagonal(1.0, 0.0, 1.0)));
  Eigen::Matrix3d same = Eigen::Matrix3d::Identity();
  same(0, 1) = same(1, 0) = 1.0;
  EXPECT_FALSE(squared_deviation(Eigen::Vector3d(1.0, 1.0, 1.0), same));
}

}  // namespace
}  // namespace overfly
