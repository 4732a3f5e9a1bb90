// Normally distributed random numbers, identical for every standard library. Private to flight and
// its sub-rooms.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include "core/motion/pose.hpp"

namespace overfly::flight {

/// Draws independent numbers of mean 0 and variance 1 (Box and Muller 1958). The sequence is a
/// function of the seed.
class NormalNoise {
 public:
  explicit NormalNoise(std::uint64_t seed) : generator_(seed) {}

  [[nodiscard]] double draw() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * kPi * uniform());
  }
  /// Two numbers for the price of one: the first is what draw() would have returned.
  [[nodiscard]] std::array<double, 2> draw_pair() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    const double angle = 2.0 * kPi * uniform();
    return {radius * std::cos(angle), radius * std::sin(angle)};
  }

 private:
  double uniform() { return static_cast<double>(generator_() >> 11U) * 0x1.0p-53; }
  std::mt19937_64 generator_;
};

}  // namespace overfly::flight
