#include "evaluation/statistics/chi_square.hpp"

#include <boost/math/distributions/chi_squared.hpp>

namespace overfly::evaluation {

double chi_square_quantile(double share, double degrees) {
  return boost::math::quantile(boost::math::chi_squared(degrees), share);
}

}  // namespace overfly::evaluation
