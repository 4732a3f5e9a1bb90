#include "sensor/pixel_chain.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace overfly::sensor {

namespace {

using Lanes = std::array<float, kChunk>;

/// Radiance this many samples ahead is prefetched: a page of memory, across which the processor
/// does not prefetch by itself.
constexpr int kPrefetchSamples = 1024;

OVERFLY_LANES void fetch_ahead(const SensorRow& row, int start) {
  constexpr int kCacheLine = 16;
  const int end = std::min(start + kPrefetchSamples + kChunk, row.readable);
  for (int i = start + kPrefetchSamples; i < end; i += kCacheLine)
    __builtin_prefetch(row.radiance + i);
}

/// Mean electrons of a chunk, including the pattern of the pixels' gains.
/// @return whether any sample is below kExactPoissonBelowE
OVERFLY_LANES bool mean_electrons(
    const PixelChain& chain, const SensorRow& row, int start, int count, Lanes& mean_e) {
  fetch_ahead(row, start);
  if (count < kChunk) mean_e.fill(kExactPoissonBelowE);
  for (int i = 0; i < count; ++i) {
    const float r2 = row.x_term[start + i] + row.y_term;
    const float transmission = fused(
        r2, fused(r2, fused(r2, chain.vignette[2], chain.vignette[1]), chain.vignette[0]), 1.0F);
    const float mean = row.radiance[start + i] * chain.electrons_per_radiance * transmission;
    mean_e[i] = std::max(mean, 0.0F);
  }
  if (row.gain_pattern != nullptr) {
    for (int i = 0; i < count; ++i) {
      mean_e[i] = std::max(mean_e[i] * row.gain_pattern[start + i], 0.0F);
    }
  }
  std::int32_t few = 0;
  for (int i = 0; i < kChunk; ++i) {
    few |= static_cast<std::int32_t>(mean_e[i] < kExactPoissonBelowE);
  }
  return few != 0;
}

/// x rounded to a whole number if |x| < 2^22, and to 1e-7 of itself above.
OVERFLY_LANES float whole(float x) { return (x + 0x1.8p23F) - 0x1.8p23F; }

/// A normal variable with the second term of the expansion of Cornish and Fisher (1938): for z
/// standard normal, mu + s z + (z^2 - 1) / 6 has the skewness of Poisson's distribution; s^2
/// excludes the variances of the term (1/18) and of the rounding (1/12). Positive, since |z| < 5.3.
/// @pre mean_e >= kExactPoissonBelowE
OVERFLY_LANES float many_electrons(float mean_e, float z) {
  const float s = std::sqrt(mean_e - 5.0F / 36.0F);
  return whole(fused(fused(z, 1.0F / 6.0F, s), z, mean_e - 1.0F / 6.0F));
}

/// exp(-x), x in [0, kExactPoissonBelowE]: 2^5 factors exp(-x / 2^5) by Taylor's series.
OVERFLY_LANES double exp_of_minus(double x) {
  const double t = -x * (1.0 / 32.0);
  double p = t * (1.0 / 3628800) + 1.0 / 362880;
  p = p * t + 1.0 / 40320;
  p = p * t + 1.0 / 5040;
  p = p * t + 1.0 / 720;
  p = p * t + 1.0 / 120;
  p = p * t + 1.0 / 24;
  p = p * t + 1.0 / 6;
  p = p * t + 0.5;
  p = p * t + 1.0;
  p = p * t + 1.0;
  p *= p;
  p *= p;
  p *= p;
  p *= p;
  return p * p;
}

/// Inversion by sequential search (Devroye 1986, "Non-uniform random variate generation", section
/// X.3.3): the smallest k with P(X <= k) >= u, for all samples of the chunk in parallel. Samples of
/// kExactPoissonBelowE and more get 0.
OVERFLY_LANES void few_electrons(const NoiseKey& key,
                                 std::uint32_t counter,
                                 const Lanes& mean_e,
                                 Lanes& electrons) {
  ChunkWords words;
  draw_words(key, counter, words);
  alignas(64) Lanes mean;
  alignas(64) Lanes wanted;
  alignas(64) Lanes probability;
  alignas(64) Lanes sum;
  for (int i = 0; i < kChunk; ++i) {
    mean[i] = mean_e[i] < kExactPoissonBelowE ? mean_e[i] : 0.0F;
    wanted[i] = uniform(words.of[i]);
    probability[i] = static_cast<float>(exp_of_minus(mean[i]));
    sum[i] = probability[i];
    electrons[i] = 0.0F;
  }
  // The sum of floats may stay below a `wanted` close to 1: terms below 3e-9 past the mode end it.
  for (int n = 1; n <= 80; ++n) {
    const auto terms = static_cast<float>(n);
    const float factor = 1.0F / terms;
    std::int32_t growing = 0;
    for (int i = 0; i < kChunk; ++i) {
      probability[i] *= mean[i] * factor;
      const bool more = ((probability[i] > 3e-9F) | (terms < mean[i])) & (sum[i] < wanted[i]);
      electrons[i] += more ? 1.0F : 0.0F;
      sum[i] += probability[i];
      growing |= static_cast<std::int32_t>(more);
    }
    if (growing == 0) break;
  }
}

/// The random numbers drawn for a chunk; the compiler makes a separate loop for each case.
enum class Drawn { kNothing, kReadNoise, kManyElectrons, kFewAndMany };

/// Data of a chunk; all arrays are indexed by its samples.
struct Chunk {
  alignas(64) Lanes mean_e;
  alignas(64) Lanes few_e;  ///< for kFewAndMany
  alignas(64) Lanes offset_e;
  ChunkWords words;  ///< for all except kNothing
  int start = 0;
  int count = kChunk;  ///< samples inside the image
  bool has_offsets = false;
};

/// Converts mean electrons to the converter's numbers.
/// @tparam kPlain  the chunk is complete and has no offsets
template <Drawn kDrawn, bool kPlain>
OVERFLY_LANES void convert(const PixelChain& chain, const Chunk& chunk, RowResult& result) {
  const auto largest = static_cast<float>(chain.largest_dn);
  const float black_and_half = chain.black_dn + 0.5F;
  std::uint32_t sum = 0;
  std::uint32_t saturated = 0;
  std::uint16_t* numbers = result.numbers + chunk.start;
  for (int i = 0; i < kChunk; ++i) {
    float electrons = chunk.mean_e[i];
    float read_z = 0.0F;
    if constexpr (kDrawn != Drawn::kNothing) {
      const NormalPair z = normal_pair(chunk.words.of[i]);
      read_z = z.second;
      if constexpr (kDrawn == Drawn::kManyElectrons) electrons = many_electrons(electrons, z.first);
      if constexpr (kDrawn == Drawn::kFewAndMany) {
        const float few = chunk.few_e[i];
        const float many = std::max(electrons, kExactPoissonBelowE);
        electrons = electrons < kExactPoissonBelowE ? few : many_electrons(many, z.first);
      }
    }
    const bool full = electrons >= chain.full_well_e;
    const float kept_e = std::min(electrons, chain.full_well_e);
    const float charge_e = kPlain ? kept_e : kept_e + chunk.offset_e[i];
    const float signal_e = fused(chain.read_noise_e, read_z, charge_e);
    const float dn = fused(signal_e, chain.dn_per_e, black_and_half);
    const auto number = static_cast<std::int32_t>(std::min(std::max(dn, 0.0F), largest));
    numbers[i] = static_cast<std::uint16_t>(number);
    const bool counts = kPlain || i < chunk.count;
    sum += counts ? static_cast<std::uint32_t>(number) : 0U;
    saturated += static_cast<std::uint32_t>(counts & (full | (number == chain.largest_dn)));
  }
  result.sum += sum;
  result.saturated += saturated;
}

template <Drawn kDrawn>
OVERFLY_LANES void convert(const PixelChain& chain, const Chunk& chunk, RowResult& result) {
  if (chunk.count == kChunk && !chunk.has_offsets) {
    convert<kDrawn, true>(chain, chunk, result);
  } else {
    convert<kDrawn, false>(chain, chunk, result);
  }
}

OVERFLY_LANES void expose_chunk(const PixelChain& chain,
                                const SensorRow& row,
                                Chunk& chunk,
                                RowResult& result) {
  const std::uint32_t counter = row.counter + static_cast<std::uint32_t>(chunk.start / 4);
  if (row.offset_pattern_e != nullptr) {
    std::copy_n(row.offset_pattern_e + chunk.start, chunk.count, chunk.offset_e.begin());
  }
  const bool few = mean_electrons(chain, row, chunk.start, chunk.count, chunk.mean_e);
  if (!chain.shot_noise && chain.read_noise_e <= 0.0F) {
    convert<Drawn::kNothing>(chain, chunk, result);
    return;
  }
  draw_words(chain.temporal, counter, chunk.words);
  if (!chain.shot_noise) {
    convert<Drawn::kReadNoise>(chain, chunk, result);
  } else if (!few) {
    convert<Drawn::kManyElectrons>(chain, chunk, result);
  } else {
    few_electrons(chain.few_electrons, counter, chunk.mean_e, chunk.few_e);
    convert<Drawn::kFewAndMany>(chain, chunk, result);
  }
}

OVERFLY_LANES void expose_chunks(const PixelChain& chain, const SensorRow& row, RowResult& result) {
  Chunk chunk;
  chunk.offset_e.fill(0.0F);
  chunk.has_offsets = row.offset_pattern_e != nullptr;
  for (; chunk.start < row.samples; chunk.start += kChunk) {
    chunk.count = std::min(kChunk, row.samples - chunk.start);
    expose_chunk(chain, row, chunk, result);
  }
}

void expose_row(const PixelChain& chain, const SensorRow& row, RowResult& result) {
  expose_chunks(chain, row, result);
}

#if defined(__x86_64__)
// Only explicit fused multiply-adds are used (-ffp-contract=off), so that every version rounds
// alike.
__attribute__((target("avx2,fma"))) void expose_row_avx2(const PixelChain& chain,
                                                         const SensorRow& row,
                                                         RowResult& result) {
  expose_chunks(chain, row, result);
}

__attribute__((target("avx512f,avx512bw,avx512dq,avx512vl,prefer-vector-width=512"))) void
expose_row_avx512(const PixelChain& chain, const SensorRow& row, RowResult& result) {
  expose_chunks(chain, row, result);
}
#endif

}  // namespace

bool supported(VectorUnits units) {
  switch (units) {
    case VectorUnits::kBest:
    case VectorUnits::kNone:
      return true;
#if defined(__x86_64__)
    case VectorUnits::kAvx2:
      return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
    case VectorUnits::kAvx512:
      return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
             __builtin_cpu_supports("avx512dq") != 0 && __builtin_cpu_supports("avx512vl") != 0;
#else
    default:
      return false;
#endif
  }
  return false;
}

ExposeRow expose_row_for(VectorUnits units) {
#if defined(__x86_64__)
  const bool best = units == VectorUnits::kBest;
  if (units == VectorUnits::kAvx512 || (best && supported(VectorUnits::kAvx512))) {
    return expose_row_avx512;
  }
  if (units == VectorUnits::kAvx2 || (best && supported(VectorUnits::kAvx2))) {
    return expose_row_avx2;
  }
#endif
  (void)units;
  return expose_row;
}

}  // namespace overfly::sensor
