// How far two images are apart.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/camera/image.hpp"

namespace overfly::testing {

/// Peak signal to noise ratio [dB]; 99 for equal images.
/// @param peak  255 of bytes, 1 of radiance
template <typename Value>
double psnr_db(const ImageBuffer<Value>& a, const ImageBuffer<Value>& b, double peak) {
  double squares = 0.0;
  for (std::size_t i = 0; i < a.data.size(); ++i) {
    const double difference = static_cast<double>(a.data[i]) - static_cast<double>(b.data[i]);
    squares += difference * difference;
  }
  if (a.data.size() != b.data.size() || a.data.empty()) return 0.0;
  const double mean = squares / static_cast<double>(a.data.size());
  return std::min(99.0, 10.0 * std::log10(peak * peak / std::max(mean, 1e-300)));
}

}  // namespace overfly::testing
