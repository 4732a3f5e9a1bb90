// The stages that act on each sample independently, from light to the converter's number.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "sensor/noise_source.hpp"
#include "sensor/vector_units.hpp"

namespace overfly::sensor {

/// Below this mean [electrons] shot noise is drawn from the Poisson distribution itself. From it on
/// it is drawn as a normal variable with the Poisson's mean, variance and skewness, rounded to
/// electrons (total variation distance at most 9e-4).
inline constexpr float kExactPoissonBelowE = 24.0F;

/// The stages' constants for one frame.
struct PixelChain {
  float electrons_per_radiance = 1.0F;
  std::array<float, 3> vignette{};  ///< a1, a2, a3; 0 = none
  bool shot_noise = false;
  float full_well_e = std::numeric_limits<float>::max();
  float read_noise_e = 0.0F;
  float dn_per_e = 1.0F;  ///< of the converter, including gain
  float black_dn = 0.0F;
  int largest_dn = 255;
  NoiseKey temporal;
  NoiseKey few_electrons;
};

/// One row of samples; colours are neighbours.
struct SensorRow {
  const float* radiance = nullptr;  ///< finite
  int samples = 0;
  int readable = 0;               ///< samples from `radiance` to the end of the image
  const float* x_term = nullptr;  ///< of each sample: (x - cx)^2 / (half diagonal)^2
  float y_term = 0.0F;
  const float* gain_pattern = nullptr;      ///< of each sample, factor; null = 1
  const float* offset_pattern_e = nullptr;  ///< of each sample; null = 0
  std::uint32_t counter = 0;                ///< of the row's first hash
};

struct RowResult {
  std::uint16_t* numbers = nullptr;  ///< of the converter; room for whole chunks
  std::uint64_t sum = 0;             ///< of the numbers, accumulated
  std::uint64_t saturated = 0;       ///< at the largest number or the full well, accumulated
};

/// Hashes needed for a row of this many samples.
[[nodiscard]] constexpr std::uint32_t counters_per_row(int samples) {
  return static_cast<std::uint32_t>((samples + kChunk - 1) / kChunk * kQuads);
}

using ExposeRow = void (*)(const PixelChain& chain, const SensorRow& row, RowResult& result);

/// The implementation compiled for the units. @pre supported(units)
[[nodiscard]] ExposeRow expose_row_for(VectorUnits units);

}  // namespace overfly::sensor
