// The sampling kernel for machines with AVX2: eight pixels at a time, with the same operations in
// the same order as the plain kernel, and therefore the same bits.
//
// The first step computes where all samples of a block lie, the second reads them. In one step the
// processor would wait for each address, whose computation is a long chain.
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

// Indices of a tile's elements, mip levels included, are exact as floats.
static_assert(2 * terrain::kTileSide * terrain::kTileSide < 1 << 24);

/// The tile's tables by mip level, and the values of one level for eight pixels. Offsets and
/// strides are floats: indices are below 2^24 and therefore exact.
struct Tables {
  __m256 offset, stride;
  __m256 scale_x, scale_y, last_x, last_y;

  OVERFLY_AVX2 static Tables of(const PackedTile& tile) {
    const auto ints = [](const auto& table) __attribute__((target("avx2"))) {
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

/// A bilinear function along one row of pixels.
struct RowLine {
  __m256 first, step;

  OVERFLY_AVX2 static RowLine of(const Bilinear4& f, float y) {
    return {_mm256_set1_ps(f[0] + f[2] * y), _mm256_set1_ps(f[1] + f[3] * y)};
  }
  [[nodiscard]] OVERFLY_AVX2 __m256 at(__m256 x) const {
    return _mm256_add_ps(first, _mm256_mul_ps(step, x));
  }
};

OVERFLY_AVX2 __m256 clamped_lanes(__m256 value, __m256 last) {
  return _mm256_min_ps(_mm256_max_ps(value, _mm256_setzero_ps()), last);
}

OVERFLY_AVX2 __m256 whole(__m256 value) {
  return _mm256_round_ps(value, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC);
}

/// @param at  the level of each pixel
OVERFLY_AVX2 Footprints footprints(const Tables& at, __m256 u, __m256 v) {
  const __m256 half = _mm256_set1_ps(0.5F);
  const __m256 s = clamped_lanes(_mm256_sub_ps(_mm256_mul_ps(u, at.scale_x), half), at.last_x);
  const __m256 t = clamped_lanes(_mm256_sub_ps(_mm256_mul_ps(v, at.scale_y), half), at.last_y);
  const __m256 column = whole(s);
  const __m256 row = whole(t);
  const __m256 element =
      _mm256_add_ps(at.offset, _mm256_add_ps(_mm256_mul_ps(row, at.stride), column));
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

OVERFLY_AVX2 Weights weights(const Footprints& at) {
  const __m256i down = rounded_share(at.down, kRowOne);
  const __m256i across = rounded_share(at.across, kColumnOne);
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
  const auto two = [&](int low, int high) __attribute__((target("avx2"))) {
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
  /// @param count  of pixels, in [1, 8]
  /// @param every  all of them, else the first and, if `last`, the last
  OVERFLY_AVX2 void ask(const std::int32_t* elements, int count, bool every, bool last) const {
    for (int plane = 0; plane < planes; ++plane) {
      const char* from = first + static_cast<std::size_t>(plane) * plane_bytes;
      const auto line = [&](int i) {
        // As _mm_prefetch. GCC 12 removes calls of functions that use nothing but that.
        asm volatile("prefetcht0 %0" : : "m"(from[kBytes * static_cast<std::size_t>(elements[i])]));
      };
      if (every) {
        for (int i = 0; i < count; ++i) line(i);
      } else {
        line(0);
        if (last) line(count - 1);
      }
    }
  }

  const char* first;
  int planes;
  std::size_t plane_bytes;
};

template <Mips kMips, bool kWide>
__attribute__((target("avx2"))) void plan_samples(const TexelBlock& block,
                                                  const PackedTile& tile,
                                                  int first_mip,
                                                  SamplePlan& plan) {
  const Tables tables = Tables::of(tile);
  const Tables tables_a = Tables::at_mip(tile, first_mip);
  const Tables tables_b = Tables::at_mip(tile, std::min(first_mip + 1, kPackedMips - 1));
  const Fetch<kWide> fetch = Fetch<kWide>::of(tile);
  const __m256 last_mip = _mm256_set1_ps(static_cast<float>(kPackedMips - 1));
  const __m256 u0 = _mm256_set1_ps(block.u0);
  const __m256 v0 = _mm256_set1_ps(block.v0);
  const int rows = block.rows;
  const int columns = block.columns;
  for (int row = 0; row < rows; ++row) {
    const auto y = static_cast<float>(row);
    const RowLine inverse_depth = RowLine::of(block.inverse_depth, y);
    const RowLine numerator_u = RowLine::of(block.numerator_u, y);
    const RowLine numerator_v = RowLine::of(block.numerator_v, y);
    const RowLine lods = RowLine::of(block.lod, y);
    const bool border = row == 0 || row == rows - 1;
    for (int column = 0; column < columns; column += 8) {
      const int pixel = row * kBlockSide + column;
      const int count = std::min(columns - column, 8);
      const bool last = column + 8 >= columns;
      const __m256 x = _mm256_add_ps(_mm256_setr_ps(0, 1, 2, 3, 4, 5, 6, 7),
                                     _mm256_set1_ps(static_cast<float>(column)));
      const __m256 depth = _mm256_div_ps(_mm256_set1_ps(1.0F), inverse_depth.at(x));
      const __m256 u = _mm256_add_ps(u0, _mm256_mul_ps(numerator_u.at(x), depth));
      const __m256 v = _mm256_add_ps(v0, _mm256_mul_ps(numerator_v.at(x), depth));
      if constexpr (kMips == Mips::kAny) {
        const __m256 lod = clamped_lanes(lods.at(x), last_mip);
        const __m256i mip = _mm256_cvttps_epi32(lod);
        _mm256_store_ps(&plan.between[pixel], _mm256_sub_ps(lod, _mm256_cvtepi32_ps(mip)));
        const __m256i next = _mm256_min_epi32(_mm256_add_epi32(mip, _mm256_set1_epi32(1)),
                                              _mm256_set1_epi32(kPackedMips - 1));
        keep<kWide>(footprints(tables.permuted(mip), u, v), pixel, plan.fine);
        keep<kWide>(footprints(tables.permuted(next), u, v), pixel, plan.coarse);
      } else {
        keep<kWide>(footprints(tables_a, u, v), pixel, plan.fine);
        if constexpr (kMips == Mips::kTwo) {
          _mm256_store_ps(&plan.between[pixel],
                          _mm256_sub_ps(lods.at(x), _mm256_set1_ps(static_cast<float>(first_mip))));
          keep<kWide>(footprints(tables_b, u, v), pixel, plan.coarse);
        }
      }
      fetch.ask(&plan.fine.element[pixel], count, border, last);
      if constexpr (kMips != Mips::kFirst) {
        fetch.ask(&plan.coarse.element[pixel], count, border, last);
      }
    }
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

__attribute__((target("avx2"))) void read_avx2(const SamplePlan& plan, float* out) {
  const PackedTile& tile = *plan.tile;
  for (int plane = 0; plane < tile.planes; ++plane, out += kBlockPixels) {
    const std::size_t first = plane * tile.plane_elements;
    if (tile.wide) {
      const std::uint32_t* pairs = &tile.wide_pairs[first];
      const auto samples = [=](int pixel, const Level& at) __attribute__((target("avx2"))) {
        return wide_samples(pairs, pixel, at);
      };
      read_plane(plan, samples, out);
    } else {
      const std::uint16_t* pairs = &tile.pairs[first];
      const auto samples = [=](int pixel, const Level& at) __attribute__((target("avx2"))) {
        return narrow_samples(pairs, pixel, at);
      };
      read_plane(plan, samples, out);
    }
  }
}

void plan_avx2(const TexelBlock& block, const PackedTile& tile, SamplePlan& plan) {
  plan.block = block;
  plan.tile = &tile;
  const BlockMips block_mips = mips_of(block);
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
  return __builtin_cpu_supports("avx2") ? kKernel : plain_sample_kernel();
}

}  // namespace overfly::renderer::raycast

#else

namespace overfly::renderer::raycast {

const SampleKernel& best_sample_kernel() { return plain_sample_kernel(); }

}  // namespace overfly::renderer::raycast

#endif
