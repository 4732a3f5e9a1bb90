// The model of a function: exact for what is known, uncertain elsewhere, blind to axes without
// effect.
#include "server/experiments/hunt/gaussian_process.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/support.hpp"

namespace overfly::server::experiments {
namespace {

using overfly::testing::larger_error;

/// Halton's sequence: points that fill the unit square.
Eigen::MatrixXd spread_points(Eigen::Index count) {
  const auto radical = [](int number, int base) {
    double value = 0.0;
    for (double share = 1.0 / base; number > 0; number /= base, share /= base) {
      value += share * (number % base);
    }
    return value;
  };
  Eigen::MatrixXd points(2, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    points(0, i) = radical(static_cast<int>(i) + 1, 2);
    points(1, i) = radical(static_cast<int>(i) + 1, 3);
  }
  return points;
}

double wave(const Eigen::VectorXd& x) { return 5.0 + 2.0 * std::sin(6.0 * x(0)); }

GaussianProcess model_of_wave(Eigen::Index count) {
  const Eigen::MatrixXd points = spread_points(count);
  Eigen::VectorXd values(count);
  for (Eigen::Index i = 0; i < count; ++i) values(i) = wave(points.col(i));
  return GaussianProcess::fit(points, values);
}

TEST(GaussianProcess, PredictsASmoothFunctionBetweenItsPoints) {
  const GaussianProcess model = model_of_wave(30);
  double error = 0.0;
  for (int i = 0; i <= 20; ++i) {
    const Eigen::Vector2d point(0.05 + 0.045 * i, 0.4);
    const auto [mean, deviation] = model.predict(point);
    error = larger_error(error, std::abs(mean - wave(point)));
    EXPECT_LT(std::abs(mean - wave(point)), 4.0 * deviation + 0.02);
  }
  EXPECT_LT(error, 0.2);  // a tenth of the wave's amplitude
}

TEST(GaussianProcess, IsCertainAtItsPointsOnly) {
  const GaussianProcess model = model_of_wave(12);
  const Eigen::MatrixXd points = spread_points(12);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    EXPECT_NEAR(model.predict(points.col(i)).mean, wave(points.col(i)), 0.05);
    EXPECT_LT(model.predict(points.col(i)).deviation, 0.2);
  }
  EXPECT_GT(model.predict(Eigen::Vector2d(1.0, 1.0)).deviation,
            2.0 * model.predict(points.col(0)).deviation);
}

TEST(GaussianProcess, RecognisesAnAxisWithoutEffect) {
  const Eigen::VectorXd lengths = model_of_wave(30).lengths();
  EXPECT_GT(lengths(1), 3.0 * lengths(0));
}

/// With known lengths the predictions of two points follow from the equations by hand: halfway
/// between equal distances the mean is that of the values.
TEST(GaussianProcess, PredictsTheMeanHalfwayBetweenTwoPoints) {
  Eigen::MatrixXd points(1, 2);
  points << 0.2, 0.8;
  const GaussianProcess model = GaussianProcess::fit(points, Eigen::Vector2d(3.0, 7.0));
  EXPECT_NEAR(model.predict(Eigen::VectorXd::Constant(1, 0.5)).mean, 5.0, 1e-9);
  EXPECT_LT(model.predict(Eigen::VectorXd::Constant(1, 0.3)).mean, 5.0);
}

TEST(GaussianProcess, AcceptsOnePointAndEqualOnes) {
  const Eigen::VectorXd one = Eigen::VectorXd::Constant(1, 0.5);
  EXPECT_DOUBLE_EQ(GaussianProcess::fit(one, Eigen::VectorXd::Constant(1, 2.0)).predict(one).mean,
                   2.0);
  const Eigen::MatrixXd same = Eigen::MatrixXd::Constant(2, 6, 0.3);
  const auto [mean, deviation] =
      GaussianProcess::fit(same, Eigen::VectorXd::LinSpaced(6, 1.0, 2.0)).predict(same.col(0));
  EXPECT_NEAR(mean, 1.5, 0.01);
  EXPECT_TRUE(std::isfinite(deviation));
}

}  // namespace
}  // namespace overfly::server::experiments
