// Noise of an image sensor, cheap enough for every pixel of a test's images.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

namespace overfly::odometry::testing {

/// Nearly normal: sums of four uniform numbers, the same for the same seed.
class GreyNoise {
 public:
  /// @param sigma  standard deviation [grey levels]
  GreyNoise(double sigma, std::uint64_t seed)
      : scale_(static_cast<float>(sigma * std::sqrt(3.0) / 65535.0)), random_(seed) {}

  float operator()() {
    const std::uint64_t bits = random_();
    const auto sum = static_cast<std::int32_t>((bits & 0xffffU) + ((bits >> 16U) & 0xffffU) +
                                               ((bits >> 32U) & 0xffffU) + (bits >> 48U));
    return scale_ * static_cast<float>(sum - 2 * 65535);
  }

 private:
  float scale_;  ///< the sum's variance is 65535^2 / 3
  std::mt19937_64 random_;
};

}  // namespace overfly::odometry::testing
