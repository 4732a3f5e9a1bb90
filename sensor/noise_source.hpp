// Counter-based random numbers: a value is a function of seed, frame, stage and place only, and
// independent of the order of the pixels and of the machine.
//
// Words: the hash pcg4d (Jarzynski, Olano 2020, "Hash functions for GPU rendering", JCGT 9(3),
// section 4.1) of a running number and three odd words made of seed, frame and stage. The upper
// half is folded into the lower at the end, because the lowest bits of its products differ so
// little between keys that the noise of two frames would be correlated by up to 6 %.
// Normals: Box and Muller 1958; logarithm, sine and cosine are polynomials (Chebyshev
// interpolation, errors below 1e-5, 1.4e-4 and 7e-6), because the C library's functions differ in
// the last bit between machines.
//
// Loops run over arrays of fixed length, which the compiler vectorises.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace overfly::sensor {

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

inline constexpr int kQuads = 64;
/// Samples processed together; one hash serves samples i, kQuads + i, 2 kQuads + i, ...
inline constexpr int kChunk = 4 * kQuads;

/// Must be inlined, so that it is compiled for the caller's vector units.
#define OVERFLY_LANES static inline __attribute__((always_inline))

/// A random word for each sample of a chunk.
struct alignas(64) ChunkWords {
  std::array<std::uint32_t, kChunk> of;
};

/// @param counter  of the chunk's first hash; chunks are kQuads apart
OVERFLY_LANES void draw_words(const NoiseKey& key, std::uint32_t counter, ChunkWords& words) {
  for (int i = 0; i < kQuads; ++i) {
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
    words.of[i] = x ^ (x >> 16U);
    words.of[kQuads + i] = y ^ (y >> 16U);
    words.of[2 * kQuads + i] = z ^ (z >> 16U);
    words.of[3 * kQuads + i] = w ^ (w >> 16U);
  }
}

/// In (0, 1], from the upper 31 bits.
OVERFLY_LANES float uniform(std::uint32_t word) {
  return (static_cast<float>(static_cast<std::int32_t>(word >> 1U)) + 0.5F) * 0x1p-31F;
}

/// a b + c, rounded once, as IEEE 754 defines it: one instruction if the vector units support it,
/// else the C library's function, which is slow and gives the same result.
OVERFLY_LANES float fused(float a, float b, float c) { return __builtin_fmaf(a, b, c); }

/// -2 ln(u) >= 0, u in (0, 1]: exponent and a polynomial in the mantissa m - 1, m in
/// [sqrt(1/2), sqrt(2)).
OVERFLY_LANES float minus_two_log(float u) {
  constexpr std::int32_t kSqrtHalf = 0x3f3504f3;
  const auto bits = std::bit_cast<std::int32_t>(u);
  const std::int32_t exponent = (bits - kSqrtHalf) >> 23;
  const float f = std::bit_cast<float>(bits - exponent * (1 << 23)) - 1.0F;
  float p = 0.28043246F;
  p = fused(p, f, -0.43931418F);
  p = fused(p, f, 0.50866712F);
  p = fused(p, f, -0.66531812F);
  p = fused(p, f, 0.9997896F);
  p = fused(p, f, -2.0000074F);
  return fused(p, f, static_cast<float>(exponent) * -1.38629436F);
}

/// Two independent standard normals.
struct NormalPair {
  float first;
  float second;
};

/// r cos(a), r sin(a) with r = sqrt(-2 ln u): the word's upper 20 bits make u = 1 - k / 2^20 (so
/// that no normal lies beyond 5.3), the next 11 the angle in (-pi/2, pi/2), the last the sign of
/// the cosine. Bits become floats as mantissas of numbers in [1, 2) and [2, 4).
OVERFLY_LANES NormalPair normal_pair(std::uint32_t word) {
  const std::uint32_t upper = ((word >> 9U) & 0x007ffff8U) | 0x3f800000U;
  const float u = 2.0F - std::bit_cast<float>(upper);
  const float r = std::sqrt(minus_two_log(u));
  // In units of pi/2, in (-1, 1), half a step off -1.
  const std::uint32_t middle = ((word << 11U) & 0x007ff000U) | 0x40000000U;
  const float x = std::bit_cast<float>(middle) - (3.0F - 0x1p-11F);
  const float x2 = x * x;
  const float s = fused(fused(0.07293465F, x2, -0.64345777F), x2, 1.5706574F);
  const float c =
      fused(fused(fused(-0.019092757F, x2, 0.25257577F), x2, -1.2334828F), x2, 0.9999932F);
  const std::uint32_t signed_r = std::bit_cast<std::uint32_t>(r) ^ (word << 31U);
  return {std::bit_cast<float>(signed_r) * c, r * (s * x)};
}

}  // namespace overfly::sensor
