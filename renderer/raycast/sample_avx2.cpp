// The sampling kernel for machines with AVX2: eight pixels at a time, the same operations in the
// same order as the plain kernel, and so the same bits.
#include <algorithm>

#include "renderer/raycast/sample.hpp"
#include "renderer/raycast/sample_weights.hpp"

#if defined(__x86_64__) && defined(__GNUC__)

#include <immintrin.h>

#define OVERFLY_AVX2 __attribute__((target("avx2"), always_inline)) inline

namespace overfly::renderer::raycast {

namespace {

struct Tables {
  __m256i offset, stride;
  __m256 scale_x, scale_y, last_x, last_y;
};

struct Footprint {
  __m256i element;
  __m256 across, down;
};

OVERFLY_AVX2 __m256 row_values(const Bilinear4& f, float y, __m256 x) {
  return _mm256_add_ps(_mm256_set1_ps(f[0] + f[2] * y),
                       _mm256_mul_ps(_mm256_set1_ps(f[1] + f[3] * y), x));
}

OVERFLY_AVX2 __m256 clamped(__m256 value, __m256 last) {
  return _mm256_min_ps(_mm256_max_ps(value, _mm256_setzero_ps()), last);
}

OVERFLY_AVX2 Footprint footprint(const Tables& tables, __m256i mip, __m256 u, __m256 v) {
  const __m256 half = _mm256_set1_ps(0.5F);
  const auto at = [&](__m256 table) __attribute__((target("avx2"))) {
    return _mm256_permutevar8x32_ps(table, mip);
  };
  const __m256 s =
      clamped(_mm256_sub_ps(_mm256_mul_ps(u, at(tables.scale_x)), half), at(tables.last_x));
  const __m256 t =
      clamped(_mm256_sub_ps(_mm256_mul_ps(v, at(tables.scale_y)), half), at(tables.last_y));
  const __m256i column = _mm256_cvttps_epi32(s);
  const __m256i row = _mm256_cvttps_epi32(t);
  const __m256i stride = _mm256_permutevar8x32_epi32(tables.stride, mip);
  const __m256i offset = _mm256_permutevar8x32_epi32(tables.offset, mip);
  return {_mm256_add_epi32(_mm256_add_epi32(offset, _mm256_mullo_epi32(row, stride)), column),
          _mm256_sub_ps(s, _mm256_cvtepi32_ps(column)),
          _mm256_sub_ps(t, _mm256_cvtepi32_ps(row))};
}

/// The two rows' weights as bytes and the two columns' as shorts, ready for the multiplications.
struct Weights {
  __m256i rows, columns;
};

OVERFLY_AVX2 __m256i scaled(__m256 share, int one) {
  return _mm256_cvttps_epi32(_mm256_add_ps(
      _mm256_mul_ps(share, _mm256_set1_ps(static_cast<float>(one))), _mm256_set1_ps(0.5F)));
}

OVERFLY_AVX2 Weights weights(const Footprint& at) {
  const __m256i down = scaled(at.down, kRowOne);
  const __m256i across = scaled(at.across, kColumnOne);
  const __m256i pair = _mm256_or_si256(_mm256_sub_epi32(_mm256_set1_epi32(kRowOne), down),
                                       _mm256_slli_epi32(down, 8));
  return {_mm256_or_si256(pair, _mm256_slli_epi32(pair, 16)),
          _mm256_or_si256(_mm256_sub_epi32(_mm256_set1_epi32(kColumnOne), across),
                          _mm256_slli_epi32(across, 16))};
}

OVERFLY_AVX2 __m256 narrow_sample(const std::uint16_t* pairs, __m256i element, const Weights& w) {
  const __m256i texels = _mm256_i32gather_epi32(reinterpret_cast<const int*>(pairs), element, 2);
  const __m256i sums = _mm256_madd_epi16(_mm256_maddubs_epi16(texels, w.rows), w.columns);
  return _mm256_mul_ps(_mm256_cvtepi32_ps(sums), _mm256_set1_ps(kPerProduct));
}

OVERFLY_AVX2 __m256 column_of(__m256i pairs, __m256 down) {
  const __m256 low = _mm256_cvtepi32_ps(_mm256_and_si256(pairs, _mm256_set1_epi32(65535)));
  const __m256 high = _mm256_cvtepi32_ps(_mm256_srli_epi32(pairs, 16));
  return _mm256_add_ps(low, _mm256_mul_ps(down, _mm256_sub_ps(high, low)));
}

OVERFLY_AVX2 __m256 wide_sample(const std::uint32_t* pairs, const Footprint& at) {
  const auto* ints = reinterpret_cast<const int*>(pairs);
  const __m256 left = column_of(_mm256_i32gather_epi32(ints, at.element, 4), at.down);
  const __m256 right = column_of(_mm256_i32gather_epi32(ints + 1, at.element, 4), at.down);
  return _mm256_add_ps(left, _mm256_mul_ps(at.across, _mm256_sub_ps(right, left)));
}

OVERFLY_AVX2 __m256 blend(__m256 a, __m256 b, __m256 share) {
  return _mm256_add_ps(a, _mm256_mul_ps(share, _mm256_sub_ps(b, a)));
}

__attribute__((target("avx2"))) void sample_avx2(const TexelBlock& block,
                                                 const PackedTile& tile,
                                                 float* out) {
  const auto ints = [](const auto& table) __attribute__((target("avx2"))) {
    return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(table.data()));
  };
  const Tables tables{ints(tile.offset),
                      ints(tile.stride),
                      _mm256_loadu_ps(tile.scale_x.data()),
                      _mm256_loadu_ps(tile.scale_y.data()),
                      _mm256_loadu_ps(tile.last_x.data()),
                      _mm256_loadu_ps(tile.last_y.data())};
  const __m256 x = _mm256_setr_ps(0, 1, 2, 3, 4, 5, 6, 7);
  const __m256 last_mip = _mm256_set1_ps(static_cast<float>(kPackedMips - 1));
  for (int row = 0; row < block.rows; ++row, out += kBlockSide) {
    const auto y = static_cast<float>(row);
    const __m256 depth = _mm256_div_ps(_mm256_set1_ps(1.0F), row_values(block.inverse_depth, y, x));
    const __m256 u = _mm256_add_ps(_mm256_set1_ps(block.u0),
                                   _mm256_mul_ps(row_values(block.numerator_u, y, x), depth));
    const __m256 v = _mm256_add_ps(_mm256_set1_ps(block.v0),
                                   _mm256_mul_ps(row_values(block.numerator_v, y, x), depth));
    const __m256 lod = clamped(row_values(block.lod, y, x), last_mip);
    const __m256i mip = _mm256_cvttps_epi32(lod);
    const __m256 between = _mm256_sub_ps(lod, _mm256_cvtepi32_ps(mip));
    const __m256i next = _mm256_min_epi32(_mm256_add_epi32(mip, _mm256_set1_epi32(1)),
                                          _mm256_set1_epi32(kPackedMips - 1));
    const Footprint fine = footprint(tables, mip, u, v);
    const Footprint coarse = footprint(tables, next, u, v);
    const Weights fine_weights = weights(fine);
    const Weights coarse_weights = weights(coarse);
    for (int plane = 0; plane < tile.planes; ++plane) {
      const std::size_t first = plane * tile.plane_elements;
      __m256 a, b;
      if (tile.wide) {
        a = wide_sample(&tile.wide_pairs[first], fine);
        b = wide_sample(&tile.wide_pairs[first], coarse);
      } else {
        a = narrow_sample(&tile.pairs[first], fine.element, fine_weights);
        b = narrow_sample(&tile.pairs[first], coarse.element, coarse_weights);
      }
      _mm256_storeu_ps(out + plane * kBlockPixels, blend(a, b, between));
    }
  }
}

}  // namespace

SampleKernel best_sample_kernel() {
  return __builtin_cpu_supports("avx2") ? sample_avx2 : sample_plain;
}

}  // namespace overfly::renderer::raycast

#else

namespace overfly::renderer::raycast {

SampleKernel best_sample_kernel() { return sample_plain; }

}  // namespace overfly::renderer::raycast

#endif

namespace overfly::renderer::raycast {

const char* name_of(SampleKernel kernel) { return kernel == sample_plain ? "plain" : "avx2"; }

}  // namespace overfly::renderer::raycast
