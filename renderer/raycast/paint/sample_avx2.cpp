// The sampling kernel for machines with AVX2: eight pixels at a time, with the same operations in
// the same order as the plain kernel, and therefore the same bits.
//
// A block is sampled in two passes: the first computes where all its samples lie, the second reads
// them. In one pass the processor would wait for each address, whose computation is a long chain.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "renderer/raycast/paint/sample.hpp"
#include "renderer/raycast/paint/sample_weights.hpp"

#if defined(__x86_64__) && defined(__GNUC__)

#include <immintrin.h>

#define OVERFLY_AVX2 __attribute__((target("avx2"), always_inline)) inline

namespace overfly::renderer::raycast {

namespace {

/// The tile's tables by mip level, and the values of one level for eight pixels.
struct Tables {
  __m256i offset, stride;
  __m256 scale_x, scale_y, last_x, last_y;

  OVERFLY_AVX2 static Tables of(const PackedTile& tile) {
    const auto ints = [](const auto& table) __attribute__((target("avx2"))) {
      return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(table.data()));
    };
    return {ints(tile.offset),
            ints(tile.stride),
            _mm256_loadu_ps(tile.scale_x.data()),
            _mm256_loadu_ps(tile.scale_y.data()),
            _mm256_loadu_ps(tile.last_x.data()),
            _mm256_loadu_ps(tile.last_y.data())};
  }
  OVERFLY_AVX2 static Tables at_mip(const PackedTile& tile, int mip) {
    return {_mm256_set1_epi32(tile.offset[mip]),
            _mm256_set1_epi32(tile.stride[mip]),
            _mm256_set1_ps(tile.scale_x[mip]),
            _mm256_set1_ps(tile.scale_y[mip]),
            _mm256_set1_ps(tile.last_x[mip]),
            _mm256_set1_ps(tile.last_y[mip])};
  }
  [[nodiscard]] OVERFLY_AVX2 Tables permuted(__m256i mip) const {
    return {_mm256_permutevar8x32_epi32(offset, mip),
            _mm256_permutevar8x32_epi32(stride, mip),
            _mm256_permutevar8x32_ps(scale_x, mip),
            _mm256_permutevar8x32_ps(scale_y, mip),
            _mm256_permutevar8x32_ps(last_x, mip),
            _mm256_permutevar8x32_ps(last_y, mip)};
  }
};

struct Footprints {
  __m256i element;
  __m256 across, down;
};

OVERFLY_AVX2 __m256 row_values(const Bilinear4& f, float y, __m256 x) {
  return _mm256_add_ps(_mm256_set1_ps(f[0] + f[2] * y),
                       _mm256_mul_ps(_mm256_set1_ps(f[1] + f[3] * y), x));
}

OVERFLY_AVX2 __m256 clamped_lanes(__m256 value, __m256 last) {
  return _mm256_min_ps(_mm256_max_ps(value, _mm256_setzero_ps()), last);
}

/// @param at  the level of each pixel
OVERFLY_AVX2 Footprints footprints(const Tables& at, __m256 u, __m256 v) {
  const __m256 half = _mm256_set1_ps(0.5F);
  const __m256 s = clamped_lanes(_mm256_sub_ps(_mm256_mul_ps(u, at.scale_x), half), at.last_x);
  const __m256 t = clamped_lanes(_mm256_sub_ps(_mm256_mul_ps(v, at.scale_y), half), at.last_y);
  const __m256i column = _mm256_cvttps_epi32(s);
  const __m256i row = _mm256_cvttps_epi32(t);
  return {_mm256_add_epi32(_mm256_add_epi32(at.offset, _mm256_mullo_epi32(row, at.stride)), column),
          _mm256_sub_ps(s, _mm256_cvtepi32_ps(column)),
          _mm256_sub_ps(t, _mm256_cvtepi32_ps(row))};
}

/// The weights of the two rows as bytes and of the two columns as shorts, ready for multiplication.
struct Weights {
  __m256i rows, columns;
};

OVERFLY_AVX2 __m256i rounded_share(__m256 share, int one) {
  return _mm256_cvttps_epi32(_mm256_add_ps(
      _mm256_mul_ps(share, _mm256_set1_ps(static_cast<float>(one))), _mm256_set1_ps(0.5F)));
}

OVERFLY_AVX2 Weights weights(const Footprints& at) {
  const __m256i down = rounded_share(at.down, kRowOne);
  const __m256i across = rounded_share(at.across, kColumnOne);
  const __m256i pair = _mm256_or_si256(_mm256_sub_epi32(_mm256_set1_epi32(kRowOne), down),
                                       _mm256_slli_epi32(down, 8));
  return {_mm256_or_si256(pair, _mm256_slli_epi32(pair, 16)),
          _mm256_or_si256(_mm256_sub_epi32(_mm256_set1_epi32(kColumnOne), across),
                          _mm256_slli_epi32(across, 16))};
}

/// Eight elements of 4 bytes at indices of elements of `bytes` bytes. Single loads take less time
/// than the gather instruction, on some processors much less.
OVERFLY_AVX2 __m256i elements_at(const void* first, const std::int32_t* index, int bytes) {
  const auto at = [&](int i) {
    std::int32_t element = 0;
    std::memcpy(&element, static_cast<const char*>(first) + std::ptrdiff_t{bytes} * index[i], 4);
    return element;
  };
  return _mm256_setr_epi32(at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7));
}

/// Where a block's samples of one mip level lie, by pixel.
struct Samples {
  alignas(32) std::array<std::int32_t, kBlockPixels> element;
  /// Of narrow texels: Weights; of wide ones: Footprints.
  alignas(32) std::array<std::int32_t, kBlockPixels> down;
  alignas(32) std::array<std::int32_t, kBlockPixels> across;
};

OVERFLY_AVX2 void store(std::int32_t* to, __m256i values) {
  _mm256_store_si256(reinterpret_cast<__m256i*>(to), values);
}

OVERFLY_AVX2 __m256i load(const std::int32_t* from) {
  return _mm256_load_si256(reinterpret_cast<const __m256i*>(from));
}

OVERFLY_AVX2 void keep(const Footprints& at, bool wide, int pixel, Samples& samples) {
  store(&samples.element[pixel], at.element);
  if (wide) {
    store(&samples.down[pixel], _mm256_castps_si256(at.down));
    store(&samples.across[pixel], _mm256_castps_si256(at.across));
    return;
  }
  const Weights w = weights(at);
  store(&samples.down[pixel], w.rows);
  store(&samples.across[pixel], w.columns);
}

OVERFLY_AVX2 __m256 narrow_samples(const std::uint16_t* pairs, int pixel, const Samples& at) {
  const __m256i texels = elements_at(pairs, &at.element[pixel], 2);
  const __m256i sums = _mm256_madd_epi16(_mm256_maddubs_epi16(texels, load(&at.down[pixel])),
                                         load(&at.across[pixel]));
  return _mm256_mul_ps(_mm256_cvtepi32_ps(sums), _mm256_set1_ps(kPerProduct));
}

OVERFLY_AVX2 __m256 column_of(__m256i pairs, __m256 down) {
  const __m256 low = _mm256_cvtepi32_ps(_mm256_and_si256(pairs, _mm256_set1_epi32(65535)));
  const __m256 high = _mm256_cvtepi32_ps(_mm256_srli_epi32(pairs, 16));
  return _mm256_add_ps(low, _mm256_mul_ps(down, _mm256_sub_ps(high, low)));
}

OVERFLY_AVX2 __m256 wide_samples(const std::uint32_t* pairs, int pixel, const Samples& at) {
  const std::int32_t* element = &at.element[pixel];
  const __m256 down = _mm256_castsi256_ps(load(&at.down[pixel]));
  const __m256 across = _mm256_castsi256_ps(load(&at.across[pixel]));
  const __m256 left = column_of(elements_at(pairs, element, 4), down);
  const __m256 right = column_of(elements_at(pairs + 1, element, 4), down);
  return _mm256_add_ps(left, _mm256_mul_ps(across, _mm256_sub_ps(right, left)));
}

OVERFLY_AVX2 __m256 blend(__m256 a, __m256 b, __m256 share) {
  return _mm256_add_ps(a, _mm256_mul_ps(share, _mm256_sub_ps(b, a)));
}

/// The mip levels used by a block's pixels.
enum class Mips {
  kFirst,  ///< all only the first one
  kTwo,    ///< all the same two
  kAny,
};

/// Values common to a whole block.
struct BlockMips {
  Mips mips = Mips::kAny;
  int first = 0;  ///< of kTwo
};

/// Rounding changes a level of detail by far less than this.
constexpr float kLodSlack = 1e-3F;

BlockMips mips_of(const TexelBlock& block) {
  const auto x = static_cast<float>(block.columns - 1);
  const auto y = static_cast<float>(block.rows - 1);
  const Bilinear4& f = block.lod;
  const float east = f[0] + f[1] * x;
  const float south = f[0] + f[2] * y;
  const float both = east + (f[2] + f[3] * x) * y;
  const float low = std::min(std::min(f[0], east), std::min(south, both)) - kLodSlack;
  const float high = std::max(std::max(f[0], east), std::max(south, both)) + kLodSlack;
  if (high <= 0.0F) return {Mips::kFirst, 0};
  if (!(low > 0.0F && high < static_cast<float>(kPackedMips - 1))) return {};
  const int first = static_cast<int>(low);
  return first == static_cast<int>(high) ? BlockMips{Mips::kTwo, first} : BlockMips{};
}

/// Asks for the cache line of a pixel's texels, for all eight pixels that lie next to it. The
/// second pass then waits less: a tenth of a picture's time.
OVERFLY_AVX2 void fetch(const PackedTile& tile, std::int32_t element) {
  if (!tile.wide) _mm_prefetch(reinterpret_cast<const char*>(&tile.pairs[element]), _MM_HINT_T0);
}

/// The samples of a block's finer and coarser mip level, and the coarser one's share.
struct Plan {
  Samples fine, coarse;
  alignas(32) std::array<float, kBlockPixels> between;
};

template <Mips kMips>
__attribute__((target("avx2"))) void plan_samples(const TexelBlock& block,
                                                  const PackedTile& tile,
                                                  int first_mip,
                                                  Plan& plan) {
  const Tables tables = Tables::of(tile);
  const Tables tables_a = Tables::at_mip(tile, first_mip);
  const Tables tables_b = Tables::at_mip(tile, std::min(first_mip + 1, kPackedMips - 1));
  const __m256 last_mip = _mm256_set1_ps(static_cast<float>(kPackedMips - 1));
  for (int row = 0; row < block.rows; ++row) {
    const auto y = static_cast<float>(row);
    for (int column = 0; column < block.columns; column += 8) {
      const int pixel = row * kBlockSide + column;
      const __m256 x = _mm256_add_ps(_mm256_setr_ps(0, 1, 2, 3, 4, 5, 6, 7),
                                     _mm256_set1_ps(static_cast<float>(column)));
      const __m256 depth =
          _mm256_div_ps(_mm256_set1_ps(1.0F), row_values(block.inverse_depth, y, x));
      const __m256 u = _mm256_add_ps(_mm256_set1_ps(block.u0),
                                     _mm256_mul_ps(row_values(block.numerator_u, y, x), depth));
      const __m256 v = _mm256_add_ps(_mm256_set1_ps(block.v0),
                                     _mm256_mul_ps(row_values(block.numerator_v, y, x), depth));
      if constexpr (kMips == Mips::kAny) {
        const __m256 lod = clamped_lanes(row_values(block.lod, y, x), last_mip);
        const __m256i mip = _mm256_cvttps_epi32(lod);
        _mm256_store_ps(&plan.between[pixel], _mm256_sub_ps(lod, _mm256_cvtepi32_ps(mip)));
        const __m256i next = _mm256_min_epi32(_mm256_add_epi32(mip, _mm256_set1_epi32(1)),
                                              _mm256_set1_epi32(kPackedMips - 1));
        keep(footprints(tables.permuted(mip), u, v), tile.wide, pixel, plan.fine);
        keep(footprints(tables.permuted(next), u, v), tile.wide, pixel, plan.coarse);
      } else {
        keep(footprints(tables_a, u, v), tile.wide, pixel, plan.fine);
        fetch(tile, plan.fine.element[pixel]);
        if constexpr (kMips == Mips::kTwo) {
          _mm256_store_ps(&plan.between[pixel],
                          _mm256_sub_ps(row_values(block.lod, y, x),
                                        _mm256_set1_ps(static_cast<float>(first_mip))));
          keep(footprints(tables_b, u, v), tile.wide, pixel, plan.coarse);
          fetch(tile, plan.coarse.element[pixel]);
        }
      }
    }
  }
}

/// @param read  the samples of eight pixels from the first
template <Mips kMips, typename Read>
OVERFLY_AVX2 void read_samples(const TexelBlock& block,
                               const Plan& plan,
                               const Read& read,
                               float* out) {
  for (int row = 0; row < block.rows; ++row) {
    for (int column = 0; column < block.columns; column += 8) {
      const int pixel = row * kBlockSide + column;
      __m256 value = read(pixel, plan.fine);
      if constexpr (kMips != Mips::kFirst) {
        value = blend(value, read(pixel, plan.coarse), _mm256_load_ps(&plan.between[pixel]));
      }
      _mm256_storeu_ps(out + pixel, value);
    }
  }
}

template <Mips kMips>
__attribute__((target("avx2"))) void sample_as(const TexelBlock& block,
                                               const PackedTile& tile,
                                               int first_mip,
                                               float* out) {
  Plan plan;
  plan_samples<kMips>(block, tile, first_mip, plan);
  for (int plane = 0; plane < tile.planes; ++plane, out += kBlockPixels) {
    const std::size_t first = plane * tile.plane_elements;
    if (tile.wide) {
      const std::uint32_t* pairs = &tile.wide_pairs[first];
      const auto read = [=](int pixel, const Samples& at) __attribute__((target("avx2"))) {
        return wide_samples(pairs, pixel, at);
      };
      read_samples<kMips>(block, plan, read, out);
    } else {
      const std::uint16_t* pairs = &tile.pairs[first];
      const auto read = [=](int pixel, const Samples& at) __attribute__((target("avx2"))) {
        return narrow_samples(pairs, pixel, at);
      };
      read_samples<kMips>(block, plan, read, out);
    }
  }
}

void sample_avx2(const TexelBlock& block, const PackedTile& tile, float* out) {
  const BlockMips block_mips = mips_of(block);
  switch (block_mips.mips) {
    case Mips::kFirst:
      return sample_as<Mips::kFirst>(block, tile, 0, out);
    case Mips::kTwo:
      return sample_as<Mips::kTwo>(block, tile, block_mips.first, out);
    case Mips::kAny:
      return sample_as<Mips::kAny>(block, tile, 0, out);
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
