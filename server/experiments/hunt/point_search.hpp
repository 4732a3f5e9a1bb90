// Where a function of several axes is looked at next, to find its lowest values with few looks.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "server/experiments/hunt/gaussian_process.hpp"

namespace overfly::server::experiments {

enum class SearchMethod {
  kModel,   ///< a Gaussian process of what is known proposes each point
  kRandom,  ///< uniformly distributed points, as a comparison
};

/// One axis of the search. Coordinates are in [0, 1]; those of an axis with values are the middles
/// of as many equal parts.
struct SearchAxis {
  std::size_t values = 0;  ///< 0: every number counts
};

/// Proposes points one after the other, each from the values at the points before it. Equal
/// arguments and values give equal points.
///
/// Method kModel (efficient global optimisation: Jones, Schonlau, Welch 1998, J. Global
/// Optimization 13, 455-492): the first points fill the space (a Latin hypercube whose points are
/// far from each other). Each further one has the largest expected improvement of the lowest value
/// (eq. 15), found by NLopt. Of several points that are wanted at the same time, the model believes
/// its own prediction until their values are known (Ginsbourger, Le Riche, Carraro 2010).
class PointSearch {
 public:
  /// @pre at least one axis
  PointSearch(std::vector<SearchAxis> axes, SearchMethod method, std::uint64_t seed);

  /// Up to `count` points that were not proposed before; fewer if the axes have no more.
  /// @pre the values of all points proposed before were told
  [[nodiscard]] std::vector<Eigen::VectorXd> next(std::size_t count);
  /// The values at the points of the last call of next(), in their order. @param values  finite
  void tell(const std::vector<double>& values);

 private:
  [[nodiscard]] Eigen::VectorXd snapped(Eigen::VectorXd point) const;
  [[nodiscard]] bool is_known(const Eigen::VectorXd& point) const;
  [[nodiscard]] bool is_exhausted() const;
  [[nodiscard]] Eigen::VectorXd random_point();
  /// A point that is not known: a random one, on a grid in the worst case the first that is left.
  [[nodiscard]] Eigen::VectorXd unknown_point();
  [[nodiscard]] std::vector<Eigen::VectorXd> start_points();
  /// Of the first `count` points.
  [[nodiscard]] GaussianProcess model_of(std::size_t count,
                                         const std::vector<double>& values) const;
  [[nodiscard]] Eigen::VectorXd most_promising() const;

  std::vector<SearchAxis> axes_;
  SearchMethod method_;
  std::mt19937_64 random_;
  std::vector<Eigen::VectorXd> start_;   ///< to be proposed first, the last one first
  std::vector<Eigen::VectorXd> points_;  ///< proposed ones
  std::vector<double> values_;           ///< told ones, of the first points
};

}  // namespace overfly::server::experiments
