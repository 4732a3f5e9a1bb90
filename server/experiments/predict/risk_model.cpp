#include "server/experiments/predict/risk_model.hpp"

#include <algorithm>
#include <cmath>

namespace overfly::server::predict {
namespace {

/// Inputs of which the worst instant of a window counts (kInputNames): rotation, translation,
/// overlap, blur.
constexpr std::size_t kFirstWorst = 5;
constexpr std::size_t kLastWorst = 8;

}  // namespace

Inputs window_inputs(const std::vector<Inputs>& instants, std::size_t index, double step_s) {
  const auto before = static_cast<std::size_t>(std::floor(kWindowS / step_s + 1e-9));
  const std::size_t first = index - std::min(index, before);
  Inputs window = instants[first];
  for (std::size_t k = first + 1; k <= index; ++k) {
    for (std::size_t i = 0; i < kInputs; ++i) {
      const bool worst = i >= kFirstWorst && i <= kLastWorst;
      window[i] = worst ? std::max(window[i], instants[k][i]) : window[i] + instants[k][i];
    }
  }
  const auto count = static_cast<double>(index - first + 1);
  for (std::size_t i = 0; i < kInputs; ++i) {
    if (i < kFirstWorst || i > kLastWorst) window[i] /= count;
  }
  return window;
}

Inputs contributions_of(const RiskModel& model, const Inputs& window) {
  Inputs contributions{};
  for (std::size_t i = 0; i < kInputs; ++i) {
    contributions[i] = model.weight[i] * (window[i] - model.mean[i]) / model.scale[i];
  }
  return contributions;
}

double hazard_of(const RiskModel& model, const Inputs& window) {
  double odds = model.bias;
  for (const double part : contributions_of(model, window)) odds += part;
  return 1.0 / (1.0 + std::exp(-odds));
}

double risk_within(double hazard, double duration_s) {
  return 1.0 - std::pow(1.0 - hazard, duration_s);
}

std::vector<double> risk_so_far(const std::vector<double>& hazards, double step_s) {
  std::vector<double> risks;
  risks.reserve(hazards.size());
  double survival = 1.0;
  for (const double hazard : hazards) {
    survival *= std::pow(1.0 - hazard, step_s);
    risks.push_back(1.0 - survival);
  }
  return risks;
}

}  // namespace overfly::server::predict
