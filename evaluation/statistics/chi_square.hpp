// Quantiles of the chi-square distribution.
#pragma once

namespace overfly::evaluation {

/// The value that a sum of `degrees` squared standard normal numbers does not exceed with the
/// probability `share`.
/// @pre share in (0, 1); degrees > 0
[[nodiscard]] double chi_square_quantile(double share, double degrees);

}  // namespace overfly::evaluation
