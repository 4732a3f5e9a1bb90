// Weights of cubic convolution.
#pragma once

#include <array>

namespace overfly::renderer {

/// Weights of the four samples around a position that lies `f` after the second, in [0, 1): Keys
/// 1981, eq. 15 (a = -1/2), at distances 1 + f, f, 1 - f, 2 - f.
template <typename T>
[[nodiscard]] std::array<T, 4> cubic_weights(double f) {
  const double f2 = f * f;
  const double f3 = f2 * f;
  return {static_cast<T>(-0.5 * f3 + f2 - 0.5 * f),
          static_cast<T>(1.5 * f3 - 2.5 * f2 + 1.0),
          static_cast<T>(-1.5 * f3 + 2.0 * f2 + 0.5 * f),
          static_cast<T>(0.5 * f3 - 0.5 * f2)};
}

}  // namespace overfly::renderer
