// The sampling kernel for machines with AVX2 and FMA: eight pixels at a time, with the same
// operations in the same order as the plain kernel, and therefore the same bits. A product and a
// sum are one instruction only where the product is exact.
//
// The first step computes where all samples of a block lie, the second reads them. In one step the
// processor would wait for each address, whose computation is a long chain.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "renderer/raycast/cache_line.hpp"
#include "renderer/raycast/paint/block_mips.hpp"
#include "renderer/raycast/paint/sample.hpp"
#include "renderer/raycast/paint/sample_weights.hpp"

#if defined(__x86_64__) && defined(__GNUC__)

#include <immintrin.h>

#define OVERFLY_AVX2 __attribute__((target("avx2,fma"), always_inline)) inline

namespace overfly::renderer::raycast {

namespace {

// Indices of a tile's elements, mip levels included, are exact as floats.
static_assert(2 * terrain::kTileSide * terrain::kTileSide < 1 << 24);

/// The tile's tables by mip level, and the values of one level for eight pixels. Offsets and
/// strides are floats: indices are below 2^24 and therefore exact.
struct Tables {
  __m256 offset, stride;
  __m256 scale_x, scale_y, last_x, last_y;

  OVERFLY_AVX2 static Tables of(const PackedTile& tile) {
    const auto ints = [](const auto& table) __attribute__((target("avx2,fma"))) {
      return _mm256_cvtepi32_ps(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(table.data())));
    };
    return {ints(tile.offset),
            ints(tile.stride),
            _mm256_loadu_ps(tile.scale_x.data()),
            _mm256_loadu_ps(tile.scale_y.data()),
            _mm256_loadu_ps(tile.last_x.data()),
            _mm256_loadu_ps(tile.last_y.data())};
  }
  OVERFLY_AVX2 static Tables at_mip(const PackedTile& tile, int mip) {
    return {_mm256_set1_ps(static_cast<float>(tile.offset[mip])),
            _mm256_set1_ps(static_cast<float>(tile.stride[mip])),
            _mm256_set1_ps(tile.scale_x[mip]),
            _mm256_set1_ps(tile.scale_y[mip]),
            _mm256_set1_ps(tile.last_x[mip]),
            _mm256_set1_ps(tile.last_y[mip])};
  }
  [[nodiscard]] OVERFLY_AVX2 Tables permuted(__m256i mip) const {
    return {_mm256_permutevar8x32_ps(offset, mip),
            _mm256_permutevar8x32_ps(stride, mip),
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

/// The bilinear functions of a block, and their values along one row of pixels.
class BlockLines {
 public:
  enum Function { kInverseDepth, kU, kV, kLod };

  OVERFLY_AVX2 explicit BlockLines(const TexelBlock& block) {
    const Bilinear4& w = block.inverse_depth;
    const Bilinear4& u = block.numerator_u;
    const Bilinear4& v = block.numerator_v;
    const Bilinear4& lod = block.lod;
    top_ = _mm256_setr_ps(w[0], u[0], v[0], lod[0], w[1], u[1], v[1], lod[1]);
    down_ = _mm256_setr_ps(w[2], u[2], v[2], lod[2], w[3], u[3], v[3], lod[3]);
  }
  OVERFLY_AVX2 void select_row(int row) {
    const __m256 y = _mm256_set1_ps(static_cast<float>(row));
    _mm256_store_ps(line_, _mm256_add_ps(top_, _mm256_mul_ps(down_, y)));
  }
  /// @param x  columns of eight pixels
  [[nodiscard]] OVERFLY_AVX2 __m256 at(Function f, __m256 x) const {
    return _mm256_add_ps(_mm256_broadcast_ss(line_ + f),
                         _mm256_mul_ps(_mm256_broadcast_ss(line_ + 4 + f), x));
  }

 private:
  __m256 top_, down_;
  alignas(32) float line_[8];  ///< by function: at column 0, then the steps
};

OVERFLY_AVX2 __m256 clamped_lanes(__m256 value, __m256 last) {
  return _mm256_min_ps(_mm256_max_ps(value, _mm256_setzero_ps()), last);
}

OVERFLY_AVX2 __m256 whole(__m256 value) {
  return _mm256_round_ps(value, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC);
}

/// A coordinate in texels of a level, clamped to it.
/// @tparam kExact  the scale is a power of two, so that its products are exact
template <bool kExact>
OVERFLY_AVX2 __m256 in_level(__m256 place, __m256 scale, __m256 last) {
  const __m256 half = _mm256_set1_ps(0.5F);
  return clamped_lanes(kExact ? _mm256_fmsub_ps(place, scale, half)
                              : _mm256_sub_ps(_mm256_mul_ps(place, scale), half),
                       last);
}

/// @param at  the level of each pixel
template <bool kExact>
OVERFLY_AVX2 Footprints footprints(const Tables& at, __m256 u, __m256 v) {
  const __m256 s = in_level<kExact>(u, at.scale_x, at.last_x);
  const __m256 t = in_level<kExact>(v, at.scale_y, at.last_y);
  const __m256 column = whole(s);
  const __m256 row = whole(t);
  // Indices are exact.
  const __m256 element = _mm256_fmadd_ps(row, at.stride, _mm256_add_ps(at.offset, column));
  return {_mm256_cvttps_epi32(element), _mm256_sub_ps(s, column), _mm256_sub_ps(t, row)};
}

/// The weights of the two rows as bytes and of the two columns as shorts, ready for multiplication.
struct Weights {
  __m256i rows, columns;
};

OVERFLY_AVX2 __m256i rounded_share(__m256 share, int one) {
  return _mm256_cvttps_epi32(_mm256_add_ps(
      _mm256_mul_ps(share, _mm256_set1_ps(static_cast<float>(one))), _mm256_set1_ps(0.5F)));
}

/// As rounded_share. The product with a power of two is exact.
OVERFLY_AVX2 __m256i rounded_exact_share(__m256 share, int one) {
  return _mm256_cvttps_epi32(
      _mm256_fmadd_ps(share, _mm256_set1_ps(static_cast<float>(one)), _mm256_set1_ps(0.5F)));
}

OVERFLY_AVX2 Weights weights(const Footprints& at) {
  const __m256i down = rounded_share(at.down, kRowOne);
  const __m256i across = rounded_exact_share(at.across, kColumnOne);
  static_assert(kRowOne == 127);  // 127 - down = 127 ^ down
  const __m256i repeated =
      _mm256_shuffle_epi8(down,
                          _mm256_broadcastsi128_si256(
                              _mm_setr_epi8(0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8, 12, 12, 12, 12)));
  return {_mm256_xor_si256(repeated, _mm256_set1_epi32(0x007F007F)),
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

using Level = SamplePlan::Level;

OVERFLY_AVX2 void store(std::int32_t* to, __m256i values) {
  _mm256_store_si256(reinterpret_cast<__m256i*>(to), values);
}

OVERFLY_AVX2 __m256i load(const std::int32_t* from) {
  return _mm256_load_si256(reinterpret_cast<const __m256i*>(from));
}

template <bool kWide>
OVERFLY_AVX2 void keep(const Footprints& at, int pixel, Level& samples) {
  store(&samples.element[pixel], at.element);
  if constexpr (kWide) {
    store(&samples.down[pixel], _mm256_castps_si256(at.down));
    store(&samples.across[pixel], _mm256_castps_si256(at.across));
    return;
  }
  const Weights w = weights(at);
  store(&samples.down[pixel], w.rows);
  store(&samples.across[pixel], w.columns);
}

OVERFLY_AVX2 __m256 narrow_samples(const std::uint16_t* pairs, int pixel, const Level& at) {
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

/// Two neighbouring elements of 4 bytes for each of four pixels: of the first two pixels in the low
/// half, of the others in the high half.
OVERFLY_AVX2 __m256 neighbours_at(const std::uint32_t* first, int a, int b, int c, int d) {
  const auto two = [&](int low, int high) __attribute__((target("avx2,fma"))) {
    const __m128i pair = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(first + low));
    return _mm_castpd_ps(
        _mm_loadh_pd(_mm_castsi128_pd(pair), reinterpret_cast<const double*>(first + high)));
  };
  return _mm256_set_m128(two(c, d), two(a, b));
}

OVERFLY_AVX2 __m256 wide_samples(const std::uint32_t* pairs, int pixel, const Level& at) {
  const std::int32_t* e = &at.element[pixel];
  const __m256 down = _mm256_castsi256_ps(load(&at.down[pixel]));
  const __m256 across = _mm256_castsi256_ps(load(&at.across[pixel]));
  // The halves of both hold the pixels 0, 1 | 4, 5 and 2, 3 | 6, 7.
  const __m256 a = neighbours_at(pairs, e[0], e[1], e[4], e[5]);
  const __m256 b = neighbours_at(pairs, e[2], e[3], e[6], e[7]);
  const __m256 left =
      column_of(_mm256_castps_si256(_mm256_shuffle_ps(a, b, _MM_SHUFFLE(2, 0, 2, 0))), down);
  const __m256 right =
      column_of(_mm256_castps_si256(_mm256_shuffle_ps(a, b, _MM_SHUFFLE(3, 1, 3, 1))), down);
  return _mm256_add_ps(left, _mm256_mul_ps(across, _mm256_sub_ps(right, left)));
}

OVERFLY_AVX2 __m256 blend(__m256 a, __m256 b, __m256 share) {
  return _mm256_add_ps(a, _mm256_mul_ps(share, _mm256_sub_ps(b, a)));
}

/// Asks for the cache lines of the texels of a block's border. A line of texels enters and leaves
/// the block there, whichever way the image is turned, so that few lines are left out.
template <bool kWide>
struct Fetch {
  static constexpr std::size_t kBytes = kWide ? sizeof(std::uint32_t) : sizeof(std::uint16_t);

  OVERFLY_AVX2 static Fetch of(const PackedTile& tile) {
    const void* first = tile.pairs.data();
    if constexpr (kWide) first = tile.wide_pairs.data();
    return {static_cast<const char*>(first), tile.planes, kBytes * tile.plane_elements};
  }
  /// @param columns  of the row
  /// @param all  the whole row, else its two ends
  OVERFLY_AVX2 void ask(const std::int32_t* elements, int columns, bool all) const {
    for (int plane = 0; plane < planes; ++plane) {
      const char* from = first + static_cast<std::size_t>(plane) * plane_bytes;
      const auto line = [&](int i) {
        request_cache_line(&from[kBytes * static_cast<std::size_t>(elements[i])]);
      };
      if (all) {
        for (int i = 0; i < columns; ++i) line(i);
      } else {
        line(0);
        line(8 * ((columns - 1) / 8));
        line(columns - 1);
      }
    }
  }

  const char* first;
  int planes;
  std::size_t plane_bytes;
};

template <Mips kMips, bool kWide>
__attribute__((target("avx2,fma"))) void plan_samples(const TexelBlock& block,
                                                      const PackedTile& tile,
                                                      int first_mip,
                                                      SamplePlan& plan) {
  constexpr bool kExact = kMips != Mips::kAny;
  const Tables tables = Tables::of(tile);
  const Tables tables_a = Tables::at_mip(tile, first_mip);
  const Tables tables_b = Tables::at_mip(tile, std::min(first_mip + 1, kPackedMips - 1));
  const Fetch<kWide> fetch = Fetch<kWide>::of(tile);
  const __m256 last_mip = _mm256_set1_ps(static_cast<float>(kPackedMips - 1));
  const __m256 u0 = _mm256_set1_ps(block.u0);
  const __m256 v0 = _mm256_set1_ps(block.v0);
  BlockLines lines(block);
  const auto plan_eight = [&](int pixel, __m256 x)
      __attribute__((target("avx2,fma"), always_inline)) {
    const __m256 depth =
        _mm256_div_ps(_mm256_set1_ps(1.0F), lines.at(BlockLines::kInverseDepth, x));
    const __m256 u = _mm256_add_ps(u0, _mm256_mul_ps(lines.at(BlockLines::kU, x), depth));
    const __m256 v = _mm256_add_ps(v0, _mm256_mul_ps(lines.at(BlockLines::kV, x), depth));
    if constexpr (kMips == Mips::kAny) {
      const __m256 lod = clamped_lanes(lines.at(BlockLines::kLod, x), last_mip);
      const __m256i mip = _mm256_cvttps_epi32(lod);
      _mm256_store_ps(&plan.between[pixel], _mm256_sub_ps(lod, _mm256_cvtepi32_ps(mip)));
      const __m256i next = _mm256_min_epi32(_mm256_add_epi32(mip, _mm256_set1_epi32(1)),
                                            _mm256_set1_epi32(kPackedMips - 1));
      keep<kWide>(footprints<kExact>(tables.permuted(mip), u, v), pixel, plan.fine);
      keep<kWide>(footprints<kExact>(tables.permuted(next), u, v), pixel, plan.coarse);
    } else {
      keep<kWide>(footprints<kExact>(tables_a, u, v), pixel, plan.fine);
      if constexpr (kMips == Mips::kTwo) {
        _mm256_store_ps(&plan.between[pixel],
                        _mm256_sub_ps(lines.at(BlockLines::kLod, x),
                                      _mm256_set1_ps(static_cast<float>(first_mip))));
        keep<kWide>(footprints<kExact>(tables_b, u, v), pixel, plan.coarse);
      }
    }
  };
  const __m256 left = _mm256_setr_ps(0, 1, 2, 3, 4, 5, 6, 7);
  const __m256 right = _mm256_setr_ps(8, 9, 10, 11, 12, 13, 14, 15);
  static_assert(kBlockSide == 16);
  const int rows = block.rows;
  const int columns = block.columns;
  for (int row = 0; row < rows; ++row) {
    lines.select_row(row);
    const int pixel = row * kBlockSide;
    plan_eight(pixel, left);
    if (columns > 8) plan_eight(pixel + 8, right);
    const bool border = row == 0 || row == rows - 1;
    fetch.ask(&plan.fine.element[pixel], columns, border);
    if constexpr (kMips != Mips::kFirst) fetch.ask(&plan.coarse.element[pixel], columns, border);
  }
}

/// @param samples  of eight pixels from the first
template <typename ReadEight>
OVERFLY_AVX2 void read_plane(const SamplePlan& plan, const ReadEight& samples, float* out) {
  for (int row = 0; row < plan.block.rows; ++row) {
    for (int column = 0; column < plan.block.columns; column += 8) {
      const int pixel = row * kBlockSide + column;
      __m256 value = samples(pixel, plan.fine);
      if (!plan.first_mip_only) {
        value = blend(value, samples(pixel, plan.coarse), _mm256_load_ps(&plan.between[pixel]));
      }
      _mm256_storeu_ps(out + pixel, value);
    }
  }
}

__attribute__((target("avx2,fma"))) void read_avx2(const SamplePlan& plan, float* out) {
  const PackedTile& tile = *plan.tile;
  for (int plane = 0; plane < tile.planes; ++plane, out += kBlockPixels) {
    const std::size_t first = plane * tile.plane_elements;
    if (tile.wide) {
      const std::uint32_t* pairs = &tile.wide_pairs[first];
      const auto samples = [=](int pixel, const Level& at) __attribute__((target("avx2,fma"))) {
        return wide_samples(pairs, pixel, at);
      };
      read_plane(plan, samples, out);
    } else {
      const std::uint16_t* pairs = &tile.pairs[first];
      const auto samples = [=](int pixel, const Level& at) __attribute__((target("avx2,fma"))) {
        return narrow_samples(pairs, pixel, at);
      };
      read_plane(plan, samples, out);
    }
  }
}

void plan_avx2(const TexelBlock& block, const PackedTile& tile, SamplePlan& plan) {
  plan.block = block;
  plan.tile = &tile;
  const BlockMips block_mips = mips_of(block, tile);
  plan.first_mip_only = block_mips.mips == Mips::kFirst;
  const auto plan_as = [&]<Mips kMips>(int first_mip) {
    if (tile.wide) return plan_samples<kMips, true>(block, tile, first_mip, plan);
    return plan_samples<kMips, false>(block, tile, first_mip, plan);
  };
  switch (block_mips.mips) {
    case Mips::kFirst:
      return plan_as.template operator()<Mips::kFirst>(0);
    case Mips::kTwo:
      return plan_as.template operator()<Mips::kTwo>(block_mips.first);
    case Mips::kAny:
      return plan_as.template operator()<Mips::kAny>(0);
  }
}

}  // namespace

const SampleKernel& best_sample_kernel() {
  static constexpr SampleKernel kKernel{"avx2", plan_avx2, read_avx2};
  const bool supported = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return supported ? kKernel : plain_sample_kernel();
}

}  // namespace overfly::renderer::raycast

#else

namespace overfly::renderer::raycast {

const SampleKernel& best_sample_kernel() { return plain_sample_kernel(); }

}  // namespace overfly::renderer::raycast

#endif
