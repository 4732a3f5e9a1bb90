// Random numbers by counter: a value is a function of seed, frame, stage and place alone, so that
// it depends neither on the order of the pixels nor on the machine.
//
// Words: the hash pcg4d (Jarzynski, Olano 2020, "Hash functions for GPU rendering", JCGT 9(3),
// section 4.1) of a running number and three odd words made of seed, frame and stage.
// Normals: Box and Muller 1958; logarithm, sine and cosine are polynomials (Chebyshev
// interpolation, absolute error below 2e-6, 2e-6 and 7e-6), because the C library's functions
// differ in the last bit between machines.
//
// Loops run over arrays of a fixed length, which the compiler turns into vector code.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace overfly::renderer {

enum class NoiseStage : std::uint32_t {
  kTemporal = 1,
  kFewElectrons,
  kGainPattern,
  kOffsetPattern
};

struct NoiseKey {
  std::uint32_t y = 1;
  std::uint32_t z = 1;
  std::uint32_t w = 1;
};

[[nodiscard]] NoiseKey noise_key(std::uint64_t seed, std::int64_t frame, NoiseStage stage);

/// A short sequence of numbers for places and phases: SplitMix64 (Steele, Lea, Flood 2014, "Fast
/// splittable pseudorandom number generators", OOPSLA, figure 16).
class SeededSequence {
 public:
  explicit SeededSequence(std::uint64_t seed) : state_(seed) {}
  /// Uniform in [0, 1), 53 bits.
  [[nodiscard]] double next();

 private:
  std::uint64_t state_;
};

inline constexpr int kPairs = 128;
/// Samples that are worked on together; sample i of a chunk belongs to pair i % kPairs.
inline constexpr int kChunk = 2 * kPairs;

/// Must be inlined to be compiled for the vector units of the caller.
#define OVERFLY_LANES static inline __attribute__((always_inline))

/// Two random words for each sample of a chunk.
struct alignas(64) ChunkWords {
  std::array<std::uint32_t, kChunk> first;
  std::array<std::uint32_t, kChunk> second;
};

/// @param counter  of the chunk's first pair; chunks are kPairs apart
OVERFLY_LANES void draw_words(const NoiseKey& key, std::uint32_t counter, ChunkWords& words) {
  for (int i = 0; i < kPairs; ++i) {
    std::uint32_t x = (counter + static_cast<std::uint32_t>(i)) * 1664525U + 1013904223U;
    std::uint32_t y = key.y;
    std::uint32_t z = key.z;
    std::uint32_t w = key.w;
    x += y * w;
    y += z * x;
    z += x * y;
    w += y * z;
    x ^= x >> 16U;
    y ^= y >> 16U;
    z ^= z >> 16U;
    w ^= w >> 16U;
    x += y * w;
    y += z * x;
    z += x * y;
    w += y * z;
    words.first[i] = x;
    words.second[i] = y;
    words.first[kPairs + i] = z;
    words.second[kPairs + i] = w;
  }
}

/// In (0, 1], from the upper 31 bits.
OVERFLY_LANES float uniform(std::uint32_t word) {
  return (static_cast<float>(static_cast<std::int32_t>(word >> 1U)) + 0.5F) * 0x1p-31F;
}

/// ln(u), u in (0, 1]: exponent and a polynomial in the mantissa m - 1, m in [sqrt(1/2), sqrt(2)).
OVERFLY_LANES float natural_log(float u) {
  constexpr std::int32_t kSqrtHalf = 0x3f3504f3;
  const auto bits = std::bit_cast<std::int32_t>(u);
  const std::int32_t exponent = (bits - kSqrtHalf) >> 23;
  const float f = std::bit_cast<float>(bits - exponent * (1 << 23)) - 1.0F;
  float p = 0.11657806F;
  p = p * f - 0.1857384F;
  p = p * f + 0.20525444F;
  p = p * f - 0.24920336F;
  p = p * f + 0.33313563F;
  p = p * f - 0.50000877F;
  p = p * f + 1.000001F;
  return p * f + static_cast<float>(exponent) * 0.69314718F;
}

/// Two independent standard normals from two words: r cos(a), r sin(a), r = sqrt(-2 ln u), with a
/// in [-pi/2, pi/2) and the sign of both from one bit.
OVERFLY_LANES void normal_pair(std::uint32_t first,
                               std::uint32_t second,
                               float& cosine,
                               float& sine) {
  const float r2 = -2.0F * natural_log(uniform(first));
  const float r = std::sqrt(r2 > 0.0F ? r2 : 0.0F);
  const auto sign = static_cast<std::int32_t>(second << 31U);
  const float signed_r = std::bit_cast<float>(std::bit_cast<std::int32_t>(r) ^ sign);
  // In units of pi/2, in [-1, 1).
  const float x = static_cast<float>(static_cast<std::int32_t>(second)) * 0x1p-31F;
  const float x2 = x * x;
  float s = -0.0043705859F;
  s = s * x2 + 0.079500007F;
  s = s * x2 - 0.64592572F;
  s = s * x2 + 1.5707951F;
  float c = -0.019092757F;
  c = c * x2 + 0.25257577F;
  c = c * x2 - 1.2334828F;
  c = c * x2 + 0.9999932F;
  cosine = signed_r * c;
  sine = signed_r * (s * x);
}

/// Two independent fields of standard normals for a chunk.
struct alignas(64) ChunkNormals {
  std::array<float, kChunk> first;
  std::array<float, kChunk> second;
};

OVERFLY_LANES void draw_normals(const NoiseKey& key, std::uint32_t counter, ChunkNormals& normals) {
  ChunkWords words;
  draw_words(key, counter, words);
  for (int i = 0; i < kChunk; ++i) {
    normal_pair(words.first[i], words.second[i], normals.first[i], normals.second[i]);
  }
}

}  // namespace overfly::renderer
