// Slowly changing errors of sensors. Private to flight/sensors.
#pragma once

#include <cmath>

#include "flight/normal_noise.hpp"

namespace overfly::flight {

/// A stationary first-order Gauss-Markov process, sampled at equal steps: its correlation over a
/// time t is exp(-t / time_s) (Gelb 1974, "Applied Optimal Estimation", section 3.8).
class Drift {
 public:
  /// @param sigma  standard deviation, in the unit of the values
  /// @param step_s  between two values
  Drift(double sigma, double time_s, double step_s)
      : sigma_(sigma), kept_(std::exp(-step_s / time_s)) {}

  /// The next value. Draws one number.
  double next(NormalNoise& noise) {
    const double drawn = sigma_ * noise.draw();
    value_ = started_ ? kept_ * value_ + std::sqrt(1.0 - kept_ * kept_) * drawn : drawn;
    started_ = true;
    return value_;
  }

 private:
  double sigma_;
  double kept_;
  double value_ = 0.0;
  bool started_ = false;
};

}  // namespace overfly::flight
