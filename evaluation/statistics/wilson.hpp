// Confidence interval of a share, such as a success rate.
#pragma once

#include <cstdint>

namespace overfly::evaluation {

/// 97.5 % quantile of the standard normal distribution: two-sided intervals of 95 %.
inline constexpr double kZ95 = 1.959963984540054;

/// Interval of a share, within [0, 1].
struct ShareInterval {
  double low = 0.0;
  double high = 1.0;

  [[nodiscard]] double half_width() const { return 0.5 * (high - low); }
};

/// Wilson's score interval: the shares p for which |successes / trials - p| is at most
/// z sqrt(p (1 - p) / trials) (Wilson 1927, J. Am. Stat. Assoc. 22, 209-212). [0, 1] without
/// trials.
/// @pre 0 <= successes <= trials, z > 0
[[nodiscard]] ShareInterval wilson_interval(std::int64_t successes,
                                            std::int64_t trials,
                                            double z = kZ95);

}  // namespace overfly::evaluation
