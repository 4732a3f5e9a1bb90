// The sRGB transfer function.
#pragma once

#include <cmath>

namespace overfly::renderer {

/// Linear light of an encoded value, both in [0, 1] (IEC 61966-2-1:1999, eq. 5 and 6).
template <typename T>
[[nodiscard]] T light_from_srgb(T encoded) {
  return encoded <= T(0.04045) ? encoded / T(12.92)
                               : std::pow((encoded + T(0.055)) / T(1.055), T(2.4));
}

}  // namespace overfly::renderer
