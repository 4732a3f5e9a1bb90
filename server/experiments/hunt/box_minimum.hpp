// Minima of functions over the unit cube, found by NLopt (Johnson, https://nlopt.readthedocs.io).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>

namespace overfly::server::experiments {

/// A function of coordinates in [0, 1].
using BoxFunction = std::function<double(const Eigen::VectorXd&)>;

struct BoxMinimum {
  Eigen::VectorXd at;
  double value = 0.0;
};

/// Improves one point without derivatives: BOBYQA, which models the function by a quadratic (Powell
/// 2009, Cambridge NA report 2009/06).
/// @param start  coordinates in [0, 1]
/// @param most_evaluations  about; at least 1
/// @return the best point seen; `start` at worst
[[nodiscard]] BoxMinimum local_minimum(const BoxFunction& function,
                                       const Eigen::VectorXd& start,
                                       int most_evaluations);

/// Searches the whole cube without derivatives, by DIRECT-L, which divides the most promising boxes
/// (Gablonsky, Kelley 2001, J. Global Optimization 21, 27-37), then improves the best point as
/// local_minimum. DIRECT never looks at the cube's faces; the second step does.
[[nodiscard]] BoxMinimum global_minimum(const BoxFunction& function,
                                        Eigen::Index axes,
                                        int most_evaluations);

}  // namespace overfly::server::experiments
