// A Gaussian process: what a function may be like between the points at which it is known.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace overfly::server::experiments {

/// A smooth function with unknown mean and a little noise, known at points of the unit cube. Its
/// correlation is Matern's with nu = 5/2 and one length for each axis (Rasmussen, Williams 2006,
/// Gaussian Processes for Machine Learning, eq. 4.17), so that axes without effect are recognised.
class GaussianProcess {
 public:
  /// Fits lengths and noise: the maximum of their posterior density, whose priors keep a fit to few
  /// points plausible. Mean and variance are integrated out (Jones, Schonlau, Welch 1998, J. Global
  /// Optimization 13, 455-492, section 2).
  /// @param points  coordinates in [0, 1], one point in each column
  /// @param values  one for each point, finite
  /// @pre at least one point
  /// Cost: grows with the cube of the number of points; 0.1 s for 100.
  [[nodiscard]] static GaussianProcess fit(const Eigen::MatrixXd& points,
                                           const Eigen::VectorXd& values);

  struct Prediction {
    double mean = 0.0;
    double deviation = 0.0;  ///< standard deviation
  };
  [[nodiscard]] Prediction predict(const Eigen::VectorXd& point) const;

  /// Distance along each axis over which the function changes.
  [[nodiscard]] Eigen::VectorXd lengths() const { return lengths_; }

 private:
  GaussianProcess() = default;
  /// @param parameters  as of the fit: logarithms of lengths and noise
  /// @return minus twice the logarithm of the posterior density, up to a constant; infinite if the
  /// points cannot be told apart
  double condition(const Eigen::VectorXd& parameters);

  Eigen::MatrixXd points_;
  Eigen::VectorXd values_;  ///< with mean 0 and variance 1
  double offset_ = 0.0;     ///< value = offset + scale * normalised value
  double scale_ = 1.0;
  Eigen::VectorXd lengths_;
  Eigen::MatrixXd factor_;  ///< lower Cholesky factor of the correlation matrix
  Eigen::VectorXd weights_;
  Eigen::VectorXd ones_;  ///< factor^-1 * 1
  double mean_ = 0.0;
  double variance_ = 1.0;
};

}  // namespace overfly::server::experiments
