// Deterministic noise: values that depend only on the place and the seed.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace overfly::terrain::synthesis {

/// Mixes a lattice point and a seed into 32 well-spread bits.
inline std::uint32_t hash(int x, int y, std::uint32_t seed) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 0x8da6b343U +
                    static_cast<std::uint32_t>(y) * 0xd8163841U + seed * 0xcb1ab31fU;
  h ^= h >> 15U;
  h *= 0x2c1b3c6dU;
  h ^= h >> 12U;
  h *= 0x297a2d39U;
  h ^= h >> 15U;
  return h;
}

/// Uniform in [0, 1).
inline float unit(std::uint32_t bits) {
  return static_cast<float>(bits >> 8U) * (1.0F / 16777216.0F);
}

inline float lerp(float a, float b, float t) { return a + t * (b - a); }

/// 0 below `low`, 1 above `high`, smooth between.
inline float smoothstep(float low, float high, float value) {
  const float t = std::clamp((value - low) / (high - low), 0.0F, 1.0F);
  return t * t * (3.0F - 2.0F * t);
}

/// Coverage by an edge: 1 well inside (negative distance), 0 well outside, linear over the width.
inline float soft(float distance_m, float width_m = 0.2F) {
  return std::clamp(0.5F - 0.5F * distance_m / width_m, 0.0F, 1.0F);
}

inline int floor_int(float value) {
  const int truncated = static_cast<int>(value);
  return truncated - (static_cast<float>(truncated) > value ? 1 : 0);
}

/// Values in [0, 1) at the corners of a cell of the lattice of noise().
struct NoiseCorners {
  float lower_left, lower_right, upper_left, upper_right;

  /// @param i, j  of the corner with the lowest coordinates
  static NoiseCorners of(int i, int j, std::uint32_t seed) {
    return {unit(hash(i, j, seed)),
            unit(hash(i + 1, j, seed)),
            unit(hash(i, j + 1, seed)),
            unit(hash(i + 1, j + 1, seed))};
  }
  /// @param u, v  place in the cell, in [0, 1)
  [[nodiscard]] float at(float u, float v) const {
    const float s = u * u * (3.0F - 2.0F * u);
    const float t = v * v * (3.0F - 2.0F * v);
    return 2.0F * lerp(lerp(lower_left, lower_right, s), lerp(upper_left, upper_right, s), t) -
           1.0F;
  }
};

/// Smooth value noise in [-1, 1] with features of size 1.
inline float noise(float x, float y, std::uint32_t seed) {
  const int i = floor_int(x);
  const int j = floor_int(y);
  return NoiseCorners::of(i, j, seed).at(x - static_cast<float>(i), y - static_cast<float>(j));
}

/// noise() for places that seldom leave a cell: it keeps the last cell's corners.
class NoiseInCell {
 public:
  float at(float x, float y, std::uint32_t seed) {
    const int i = floor_int(x);
    const int j = floor_int(y);
    if (i != i_ || j != j_ || seed != seed_) {
      corners_ = NoiseCorners::of(i, j, seed);
      i_ = i;
      j_ = j;
      seed_ = seed;
    }
    return corners_.at(x - static_cast<float>(i), y - static_cast<float>(j));
  }

 private:
  int i_ = 0;
  int j_ = 0;
  std::uint32_t seed_ = 0;
  NoiseCorners corners_ = NoiseCorners::of(0, 0, 0);
};

/// Sum of `octaves` noises, each with half the size and `gain` times the strength of the preceding
/// one; about [-1, 1].
inline float fractal(float x, float y, int octaves, float gain, std::uint32_t seed) {
  float sum = 0.0F;
  float weight = 1.0F;
  float total = 0.0F;
  for (int k = 0; k < octaves; ++k) {
    sum += weight * noise(x, y, seed + static_cast<std::uint32_t>(k) * 101U);
    total += weight;
    weight *= gain;
    // A rotation between octaves hides the lattice's axes.
    const float turned = 1.6F * x - 1.2F * y;
    y = 1.2F * x + 1.6F * y;
    x = turned + 17.3F;
  }
  return 1.6F * sum / total;
}

/// A stream of uniform numbers for planning.
class Dice {
 public:
  explicit Dice(std::uint32_t seed) : seed_(seed) {}
  float unit() { return synthesis::unit(hash(count_++, 7, seed_)); }
  float between(float low, float high) { return lerp(low, high, unit()); }
  /// In [0, count).
  int below(int count) { return std::min(count - 1, static_cast<int>(unit() * count)); }
  bool chance(float probability) { return unit() < probability; }
  std::uint32_t seed() { return hash(count_++, 11, seed_); }

 private:
  std::uint32_t seed_;
  int count_ = 0;
};

}  // namespace overfly::terrain::synthesis
