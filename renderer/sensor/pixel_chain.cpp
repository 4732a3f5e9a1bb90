#include "renderer/sensor/pixel_chain.hpp"

#include <algorithm>
#include <array>

namespace overfly::renderer {

namespace {

using Lanes = std::array<float, kChunk>;

/// Keeps conversions to integers defined; far above any full well.
constexpr float kMostElectrons = 1e9F;

/// What the light of a chunk leaves on average, patterns of the gain included.
OVERFLY_LANES void mean_electrons(
    const PixelChain& chain, const SensorRow& row, int start, int count, Lanes& mean_e) {
  if (count < kChunk) mean_e.fill(0.0F);
  for (int i = 0; i < count; ++i) {
    mean_e[i] = row.radiance[start + i] * chain.electrons_per_radiance;
  }
  if (chain.vignetting) {
    for (int i = 0; i < count; ++i) {
      const float r2 = row.x_term[start + i] + row.y_term;
      mean_e[i] *=
          1.0F + r2 * (chain.vignette[0] + r2 * (chain.vignette[1] + r2 * chain.vignette[2]));
    }
  }
  if (row.gain_pattern != nullptr) {
    for (int i = 0; i < count; ++i) mean_e[i] *= row.gain_pattern[start + i];
  }
  for (int i = 0; i < kChunk; ++i) {
    const float positive = mean_e[i] > 0.0F ? mean_e[i] : 0.0F;
    mean_e[i] = positive < kMostElectrons ? positive : kMostElectrons;
  }
}

/// Normal with the second term of the expansion of Cornish and Fisher (1938): for z standard
/// normal, mu + s z + (z^2 - 1) / 6 has the skewness of Poisson's distribution; s^2 leaves out the
/// variances that the term (1/18) and the rounding (1/12) bring.
OVERFLY_LANES void many_electrons(const Lanes& mean_e, const Lanes& normal, Lanes& electrons) {
  for (int i = 0; i < kChunk; ++i) {
    const float variance = mean_e[i] - 5.0F / 36.0F;
    const float s = std::sqrt(variance > 0.0F ? variance : 0.0F);
    const float z = normal[i];
    const float drawn = mean_e[i] + s * z + (z * z - 1.0F) * (1.0F / 6.0F) + 0.5F;
    electrons[i] = static_cast<float>(static_cast<std::int32_t>(drawn > 0.0F ? drawn : 0.0F));
  }
}

/// exp(-x), x in [0, kExactPoissonBelowE]: 2^5 factors exp(-x / 2^5) by Taylor's series.
OVERFLY_LANES double exp_of_minus(double x) {
  const double t = -x * (1.0 / 32.0);
  double p = 1.0 / 3628800.0;
  for (const double inverse_factorial : {1.0 / 362880,
                                         1.0 / 40320,
                                         1.0 / 5040,
                                         1.0 / 720,
                                         1.0 / 120,
                                         1.0 / 24,
                                         1.0 / 6,
                                         0.5,
                                         1.0,
                                         1.0}) {
    p = p * t + inverse_factorial;
  }
  p *= p;
  p *= p;
  p *= p;
  p *= p;
  return p * p;
}

/// Inversion by sequential search (Devroye 1986, "Non-uniform random variate generation",
/// section X.3.3): the smallest k with P(X <= k) >= u, all samples of the chunk in step.
OVERFLY_LANES void few_electrons(const NoiseKey& key,
                                 std::uint32_t counter,
                                 const Lanes& mean_e,
                                 Lanes& electrons) {
  ChunkWords words;
  draw_words(key, counter, words);
  Lanes mean;
  Lanes wanted;
  Lanes probability;
  Lanes sum;
  Lanes k;
  for (int i = 0; i < kChunk; ++i) {
    mean[i] = mean_e[i] < kExactPoissonBelowE ? mean_e[i] : 0.0F;
    wanted[i] = uniform(words.first[i]);
    probability[i] = static_cast<float>(exp_of_minus(mean[i]));
    sum[i] = probability[i];
    k[i] = 0.0F;
  }
  // The sum of floats may stay below a `wanted` next to 1: terms below 3e-9 past the mode end it.
  for (int n = 1; n <= 80; ++n) {
    const float factor = 1.0F / static_cast<float>(n);
    std::int32_t growing = 0;
    for (int i = 0; i < kChunk; ++i) {
      probability[i] *= mean[i] * factor;
      const bool counts = probability[i] > 3e-9F || static_cast<float>(n) < mean[i];
      const bool more = counts && sum[i] < wanted[i];
      k[i] += more ? 1.0F : 0.0F;
      sum[i] += probability[i];
      growing |= static_cast<std::int32_t>(more);
    }
    if (growing == 0) break;
  }
  for (int i = 0; i < kChunk; ++i) {
    electrons[i] = mean_e[i] < kExactPoissonBelowE ? k[i] : electrons[i];
  }
}

OVERFLY_LANES bool any_below(const Lanes& mean_e, float limit) {
  std::int32_t found = 0;
  for (int i = 0; i < kChunk; ++i) found |= static_cast<std::int32_t>(mean_e[i] < limit);
  return found != 0;
}

OVERFLY_LANES void add_dark_noise(const PixelChain& chain,
                                  const SensorRow& row,
                                  int start,
                                  int count,
                                  const Lanes& normal,
                                  Lanes& electrons) {
  if (chain.read_noise_e > 0.0F) {
    for (int i = 0; i < kChunk; ++i) electrons[i] += chain.read_noise_e * normal[i];
  }
  if (row.offset_pattern_e != nullptr) {
    for (int i = 0; i < count; ++i) electrons[i] += row.offset_pattern_e[start + i];
  }
}

OVERFLY_LANES void convert(const PixelChain& chain,
                           int start,
                           int count,
                           const Lanes& electrons,
                           const std::array<std::int32_t, kChunk>& well_full,
                           RowResult& result) {
  std::array<std::int32_t, kChunk> numbers;
  const auto largest = static_cast<float>(chain.largest_dn);
  for (int i = 0; i < kChunk; ++i) {
    const float dn = electrons[i] * chain.dn_per_e + chain.black_dn + 0.5F;
    const float positive = dn > 0.0F ? dn : 0.0F;
    numbers[i] = static_cast<std::int32_t>(positive < largest ? positive : largest);
  }
  std::uint32_t sum = 0;
  std::uint32_t saturated = 0;
  for (int i = 0; i < count; ++i) {
    sum += static_cast<std::uint32_t>(numbers[i]);
    saturated +=
        static_cast<std::uint32_t>((numbers[i] == chain.largest_dn ? 1 : 0) | well_full[i]);
  }
  for (int i = 0; i < kChunk; ++i)
    result.numbers[start + i] = static_cast<std::uint16_t>(numbers[i]);
  result.sum += sum;
  result.saturated += saturated;
}

OVERFLY_LANES void expose_chunk(const PixelChain& chain,
                                const SensorRow& row,
                                int start,
                                RowResult& result) {
  const int count = std::min(kChunk, row.samples - start);
  const std::uint32_t counter = row.counter + static_cast<std::uint32_t>(start / 2);
  alignas(64) Lanes mean_e;
  alignas(64) Lanes electrons;
  ChunkNormals normals;
  mean_electrons(chain, row, start, count, mean_e);
  if (chain.shot_noise || chain.read_noise_e > 0.0F) draw_normals(chain.temporal, counter, normals);
  if (chain.shot_noise) {
    many_electrons(mean_e, normals.first, electrons);
    if (any_below(mean_e, kExactPoissonBelowE)) {
      few_electrons(chain.few_electrons, counter, mean_e, electrons);
    }
  } else {
    electrons = mean_e;
  }
  alignas(64) std::array<std::int32_t, kChunk> well_full{};
  if (chain.full_well_e > 0.0F) {
    for (int i = 0; i < kChunk; ++i) {
      well_full[i] = electrons[i] >= chain.full_well_e ? 1 : 0;
      electrons[i] = well_full[i] != 0 ? chain.full_well_e : electrons[i];
    }
  }
  add_dark_noise(chain, row, start, count, normals.second, electrons);
  convert(chain, start, count, electrons, well_full, result);
}

OVERFLY_LANES void expose_chunks(const PixelChain& chain, const SensorRow& row, RowResult& result) {
  for (int start = 0; start < row.samples; start += kChunk) {
    expose_chunk(chain, row, start, result);
  }
}

void expose_row(const PixelChain& chain, const SensorRow& row, RowResult& result) {
  expose_chunks(chain, row, result);
}

#if defined(__x86_64__)
// Fused multiply-add stays off (-ffp-contract=off): every version rounds alike.
__attribute__((target("avx2"))) void expose_row_avx2(const PixelChain& chain,
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
      return __builtin_cpu_supports("avx2") != 0;
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

}  // namespace overfly::renderer
