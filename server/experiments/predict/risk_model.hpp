// The probability that an estimator loses track, from the features of a flight.
//
// In each second of a flight the estimator is lost with a probability (the hazard) that is a
// logistic function of the features in that second: a survival model in discrete time (Cox 1972,
// "Regression models and life-tables", J. R. Stat. Soc. B 34(2), section 6). It was fitted to
// recorded flights of the native estimator (risk_coefficients.cpp).
#pragma once

#include <cstddef>
#include <vector>

#include "server/experiments/predict/features/features.hpp"

namespace overfly::server::predict {

/// hazard = 1 / (1 + exp(-(bias + sum of weight (input - mean) / scale))).
struct RiskModel {
  double bias = 0.0;
  Inputs mean{};    ///< over the fitted windows
  Inputs scale{};   ///< their standard deviations, > 0
  Inputs weight{};  ///< log odds per standard deviation
};

/// The fitted model (risk_coefficients.cpp).
[[nodiscard]] const RiskModel& fitted_model();

/// Span of the features that decide the hazard of an instant: those up to so long before it.
inline constexpr double kWindowS = 1.0;

/// The inputs of a window that ends at instant `index`: motion, blur and lost overlap of its worst
/// instant, and the mean of the others. @param step_s  between instants, > 0
[[nodiscard]] Inputs window_inputs(const std::vector<Inputs>& instants,
                                   std::size_t index,
                                   double step_s);

/// Probability of a loss within a second.
[[nodiscard]] double hazard_of(const RiskModel& model, const Inputs& window);
/// Of a loss within `duration_s` of such seconds.
[[nodiscard]] double risk_within(double hazard, double duration_s);
/// Of a loss from the first to the k-th window, for each k. @param step_s  between windows
[[nodiscard]] std::vector<double> risk_so_far(const std::vector<double>& hazards, double step_s);

/// What an input adds to the log odds, relative to the mean of the fitted windows.
[[nodiscard]] Inputs contributions_of(const RiskModel& model, const Inputs& window);

}  // namespace overfly::server::predict
