#include "server/experiments/hunt/gaussian_process.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "server/experiments/hunt/box_minimum.hpp"

namespace overfly::server::experiments {
namespace {

/// A parameter of the fit: its logarithm is distributed normally before any point is known.
struct Prior {
  double mode;
  double deviation;  ///< of the natural logarithm
};
/// Lengths from 0.15 to 1.6 are likely: a border of survival crosses the limits once or twice.
constexpr Prior kLength{0.5, 0.6};
/// Variance of the noise as a share of the function's.
constexpr Prior kNoise{1e-3, 1.5};
/// The fit looks at most so many deviations away from the mode.
constexpr double kRange = 3.0;
/// Prior of the variance: as if two normalised values had been seen before.
constexpr double kKnownValues = 2.0;

double correlation(double distance) {
  const double r = std::sqrt(5.0) * distance;
  return (1.0 + r + r * r / 3.0) * std::exp(-r);
}

}  // namespace

double GaussianProcess::condition(const Eigen::VectorXd& parameters) {
  const Eigen::Index axes = points_.rows();
  const Eigen::Index count = points_.cols();
  lengths_ = parameters.head(axes).array().exp();
  const double noise = std::exp(parameters(axes));
  const Eigen::MatrixXd scaled = lengths_.cwiseInverse().asDiagonal() * points_;
  Eigen::MatrixXd R(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      R(i, j) = correlation((scaled.col(i) - scaled.col(j)).norm());
    }
    R(i, i) = 1.0 + noise;
  }
  const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> decomposition(R);
  if (decomposition.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  factor_ = decomposition.matrixL();
  const auto lower = factor_.triangularView<Eigen::Lower>();
  ones_ = lower.solve(Eigen::VectorXd::Ones(count));
  const Eigen::VectorXd values = lower.solve(values_);
  mean_ = ones_.dot(values) / ones_.squaredNorm();
  const Eigen::VectorXd rest = values - mean_ * ones_;
  weights_ = factor_.transpose().triangularView<Eigen::Upper>().solve(rest);
  const double known = kKnownValues + static_cast<double>(count);
  variance_ = (rest.squaredNorm() + kKnownValues) / known;
  double surprise = known * std::log(variance_) + 2.0 * factor_.diagonal().array().log().sum();
  for (Eigen::Index axis = 0; axis <= axes; ++axis) {
    const Prior& prior = axis < axes ? kLength : kNoise;
    surprise += std::pow((parameters(axis) - std::log(prior.mode)) / prior.deviation, 2);
  }
  return surprise;
}

GaussianProcess GaussianProcess::fit(const Eigen::MatrixXd& points, const Eigen::VectorXd& values) {
  constexpr int kEvaluationsPerParameter = 25;
  GaussianProcess process;
  process.points_ = points;
  process.offset_ = values.mean();
  const double spread = std::sqrt((values.array() - process.offset_).square().mean());
  process.scale_ = spread > 0.0 ? spread : 1.0;
  process.values_ = (values.array() - process.offset_) / process.scale_;
  const Eigen::Index axes = points.rows();
  const auto parameters_at = [&](const Eigen::VectorXd& unit) {
    Eigen::VectorXd parameters(axes + 1);
    for (Eigen::Index axis = 0; axis <= axes; ++axis) {
      const Prior& prior = axis < axes ? kLength : kNoise;
      parameters(axis) = std::log(prior.mode) + kRange * prior.deviation * (2.0 * unit(axis) - 1.0);
    }
    return parameters;
  };
  const BoxMinimum best = local_minimum(
      [&](const Eigen::VectorXd& unit) { return process.condition(parameters_at(unit)); },
      Eigen::VectorXd::Constant(axes + 1, 0.5),
      kEvaluationsPerParameter * static_cast<int>(axes + 1));
  process.condition(parameters_at(best.at));
  return process;
}

GaussianProcess::Prediction GaussianProcess::predict(const Eigen::VectorXd& point) const {
  Eigen::VectorXd r(points_.cols());
  for (Eigen::Index i = 0; i < points_.cols(); ++i) {
    r(i) = correlation((points_.col(i) - point).cwiseQuotient(lengths_).norm());
  }
  const double mean = mean_ + r.dot(weights_);
  const Eigen::VectorXd solved = factor_.triangularView<Eigen::Lower>().solve(r);
  const double unexplained = 1.0 - ones_.dot(solved);
  const double share = 1.0 - solved.squaredNorm() + unexplained * unexplained / ones_.squaredNorm();
  return {offset_ + scale_ * mean, scale_ * std::sqrt(variance_ * std::max(share, 0.0))};
}

}  // namespace overfly::server::experiments
