#include "server/experiments/hunt/box_minimum.hpp"

#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace overfly::server::experiments {
namespace {

/// What NLopt calls. Keeps the best point itself, because NLopt's answer is undefined after some
/// failures (round-off in BOBYQA).
struct Evaluation {
  const BoxFunction& function;
  BoxMinimum best;

  static double call(unsigned count, const double* at, double* /*gradient*/, void* data) {
    auto& evaluation = *static_cast<Evaluation*>(data);
    const Eigen::Map<const Eigen::VectorXd> point(at, static_cast<Eigen::Index>(count));
    const double value = evaluation.function(point);
    if (value < evaluation.best.value) evaluation.best = {point, value};
    return value;
  }
};

void run(nlopt_algorithm algorithm, int most_evaluations, Evaluation& evaluation) {
  constexpr double kFirstStep = 0.1;
  constexpr double kSmallestStep = 1e-3;
  const auto axes = static_cast<unsigned>(evaluation.best.at.size());
  const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> optimiser(
      nlopt_create(algorithm, axes), &nlopt_destroy);
  nlopt_set_lower_bounds1(optimiser.get(), 0.0);
  nlopt_set_upper_bounds1(optimiser.get(), 1.0);
  nlopt_set_min_objective(optimiser.get(), &Evaluation::call, &evaluation);
  nlopt_set_maxeval(optimiser.get(), most_evaluations);
  nlopt_set_xtol_abs1(optimiser.get(), kSmallestStep);
  nlopt_set_initial_step1(optimiser.get(), kFirstStep);
  Eigen::VectorXd at = evaluation.best.at;
  double value = 0.0;
  // Every end is a good one: limit of evaluations, tolerance, round-off.
  (void)nlopt_optimize(optimiser.get(), at.data(), &value);
}

}  // namespace

BoxMinimum local_minimum(const BoxFunction& function,
                         const Eigen::VectorXd& start,
                         int most_evaluations) {
  Evaluation evaluation{function, {start, function(start)}};
  run(NLOPT_LN_BOBYQA, most_evaluations, evaluation);
  return evaluation.best;
}

BoxMinimum global_minimum(const BoxFunction& function, Eigen::Index axes, int most_evaluations) {
  const Eigen::VectorXd middle = Eigen::VectorXd::Constant(axes, 0.5);
  Evaluation evaluation{function, {middle, function(middle)}};
  run(NLOPT_GN_DIRECT_L, most_evaluations, evaluation);
  return local_minimum(function, evaluation.best.at, std::max(1, most_evaluations / 4));
}

}  // namespace overfly::server::experiments
