#include "odometry/image/patch_samples.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#endif

namespace overfly::odometry {

namespace {

constexpr float kReach = 0.5F * (kBorderSide - 1);

/// Where a line of samples starts, in the numerator's units, and its depth there.
struct LineStart {
  Eigen::Vector2f place;
  float depth;

  LineStart(const SampledWarp& warp, int row) {
    const Eigen::Vector2f left(-kReach, static_cast<float>(row) - kReach);
    place = warp.A * left;
    depth = 1.0F + warp.g.dot(left);
  }
};

/// Weights of the four pixels around a place, in reading order.
struct FourWeights {
  float w00, w01, w10, w11;

  FourWeights(float ax, float ay)
      : w00((1.0F - ax) * (1.0F - ay)),
        w01(ax * (1.0F - ay)),
        w10((1.0F - ax) * ay),
        w11(ax * ay) {}
};

void warped_plain(const cv::Mat& image, const SampledWarp& warp, BorderPatch& patch) {
  float* out = patch.data();
  for (int row = 0; row < kBorderSide; ++row, out += kBorderSide) {
    const LineStart start(warp, row);
    for (int column = 0; column < kBorderSide; ++column) {
      const auto step = static_cast<float>(column);
      const float scale = 1.0F / (start.depth + step * warp.g.x());
      const float x = warp.centre.x() + scale * (start.place.x() + step * warp.A(0, 0));
      const float y = warp.centre.y() + scale * (start.place.y() + step * warp.A(1, 0));
      const std::int32_t x0 = std::min(static_cast<std::int32_t>(x), image.cols - 2);
      const std::int32_t y0 = std::min(static_cast<std::int32_t>(y), image.rows - 2);
      const float ax = x - static_cast<float>(x0);
      const float ay = y - static_cast<float>(y0);
      const std::uint8_t* top = image.ptr<std::uint8_t>(y0) + x0;
      const std::uint8_t* bottom = top + image.step;
      out[column] = (1.0F - ay) * ((1.0F - ax) * top[0] + ax * top[1]) +
                    ay * ((1.0F - ax) * bottom[0] + ax * bottom[1]);
    }
  }
}

void shifted_plain(const cv::Mat& image, float x, float y, float* out) {
  const int x0 = static_cast<int>(x);
  const int y0 = static_cast<int>(y);
  const FourWeights w(x - static_cast<float>(x0), y - static_cast<float>(y0));
  for (int row = 0; row < kPatchSize; ++row, out += kPatchSize) {
    const std::uint8_t* top = image.ptr<std::uint8_t>(y0 + row) + x0;
    const std::uint8_t* bottom = top + image.step;
    for (int i = 0; i < kPatchSize; ++i) {
      out[i] = w.w00 * top[i] + w.w01 * top[i + 1] + w.w10 * bottom[i] + w.w11 * bottom[i + 1];
    }
  }
}

#if defined(__x86_64__) && defined(__GNUC__)

#define OVERFLY_AVX2 __attribute__((target("avx2"), always_inline)) inline

/// Eight pairs of neighbouring pixels, of which the first `count` are read.
template <int kCount>
OVERFLY_AVX2 __m256i pairs_at(const std::uint8_t* first, const std::int32_t* offsets) {
  const auto pair = [&](int i) -> short {
    std::int16_t two = 0;
    if (i < kCount) std::memcpy(&two, first + offsets[i], sizeof(two));
    return two;
  };
  return _mm256_cvtepu16_epi32(
      _mm_setr_epi16(pair(0), pair(1), pair(2), pair(3), pair(4), pair(5), pair(6), pair(7)));
}

/// The mean of the pairs' two pixels by distance.
OVERFLY_AVX2 __m256 mean_of_pairs(__m256i pairs, __m256 share_left, __m256 share_right) {
  const __m256 left = _mm256_cvtepi32_ps(_mm256_and_si256(pairs, _mm256_set1_epi32(255)));
  const __m256 right = _mm256_cvtepi32_ps(_mm256_srli_epi32(pairs, 8));
  return _mm256_add_ps(_mm256_mul_ps(share_left, left), _mm256_mul_ps(share_right, right));
}

/// Where the samples of a patch lie: computed before any is read, so that the processor reads many
/// at once.
struct SamplePlaces {
  static constexpr std::size_t kCount = std::size_t{kBorderSide} * kSampleLine;

  alignas(32) std::int32_t offset[kCount];  ///< of the upper left pixel [bytes]
  alignas(32) float across[kCount];
  alignas(32) float down[kCount];
};

__attribute__((target("avx2"))) void find_places(const cv::Mat& image,
                                                 const SampledWarp& warp,
                                                 SamplePlaces& places) {
  const __m256 one = _mm256_set1_ps(1.0F);
  const __m256 g = _mm256_set1_ps(warp.g.x());
  const __m256 a_x = _mm256_set1_ps(warp.A(0, 0));
  const __m256 a_y = _mm256_set1_ps(warp.A(1, 0));
  const __m256 centre_x = _mm256_set1_ps(warp.centre.x());
  const __m256 centre_y = _mm256_set1_ps(warp.centre.y());
  const __m256i last_x = _mm256_set1_epi32(image.cols - 2);
  const __m256i last_y = _mm256_set1_epi32(image.rows - 2);
  const __m256i stride = _mm256_set1_epi32(static_cast<std::int32_t>(image.step[0]));
  __m256 steps = _mm256_setr_ps(0, 1, 2, 3, 4, 5, 6, 7);
  for (int half = 0; half < kSampleLine; half += 8) {
    const __m256 more_depth = _mm256_mul_ps(steps, g);
    const __m256 more_x = _mm256_mul_ps(steps, a_x);
    const __m256 more_y = _mm256_mul_ps(steps, a_y);
    for (int row = 0; row < kBorderSide; ++row) {
      const LineStart start(warp, row);
      const __m256 scale =
          _mm256_div_ps(one, _mm256_add_ps(_mm256_set1_ps(start.depth), more_depth));
      const __m256 numerator_x = _mm256_add_ps(_mm256_set1_ps(start.place.x()), more_x);
      const __m256 numerator_y = _mm256_add_ps(_mm256_set1_ps(start.place.y()), more_y);
      const __m256 x = _mm256_add_ps(centre_x, _mm256_mul_ps(scale, numerator_x));
      const __m256 y = _mm256_add_ps(centre_y, _mm256_mul_ps(scale, numerator_y));
      const __m256i x0 = _mm256_min_epi32(_mm256_cvttps_epi32(x), last_x);
      const __m256i y0 = _mm256_min_epi32(_mm256_cvttps_epi32(y), last_y);
      const int i = row * kSampleLine + half;
      _mm256_store_si256(reinterpret_cast<__m256i*>(places.offset + i),
                         _mm256_add_epi32(_mm256_mullo_epi32(y0, stride), x0));
      _mm256_store_ps(places.across + i, _mm256_sub_ps(x, _mm256_cvtepi32_ps(x0)));
      _mm256_store_ps(places.down + i, _mm256_sub_ps(y, _mm256_cvtepi32_ps(y0)));
    }
    steps = _mm256_add_ps(steps, _mm256_set1_ps(8.0F));
  }
}

/// Eight samples, of which the first `kCount` are valid. @param first  of the places
template <int kCount>
OVERFLY_AVX2 __m256 eight_samples(const cv::Mat& image, const SamplePlaces& places, int first) {
  const __m256 one = _mm256_set1_ps(1.0F);
  const __m256 right = _mm256_load_ps(places.across + first);
  const __m256 left = _mm256_sub_ps(one, right);
  const __m256 low = _mm256_load_ps(places.down + first);
  const std::int32_t* offsets = places.offset + first;
  const __m256 top = mean_of_pairs(pairs_at<kCount>(image.data, offsets), left, right);
  const __m256 bottom =
      mean_of_pairs(pairs_at<kCount>(image.data + image.step[0], offsets), left, right);
  return _mm256_add_ps(_mm256_mul_ps(_mm256_sub_ps(one, low), top), _mm256_mul_ps(low, bottom));
}

__attribute__((target("avx2"))) void warped_avx2(const cv::Mat& image,
                                                 const SampledWarp& warp,
                                                 BorderPatch& patch) {
  static_assert(kSampleLine == 16);
  SamplePlaces places;
  find_places(image, warp, places);
  float* out = patch.data();
  for (int row = 0; row < kBorderSide; ++row, out += kBorderSide) {
    const int first = row * kSampleLine;
    _mm256_storeu_ps(out, eight_samples<8>(image, places, first));
    _mm256_storeu_ps(out + 8, eight_samples<kBorderSide - 8>(image, places, first + 8));
  }
}

/// The weighted sum of four pixels, in the order of the plain function.
OVERFLY_AVX2 __m256 weighted(const FourWeights& w, __m256 p00, __m256 p01, __m256 p10, __m256 p11) {
  const __m256 top = _mm256_add_ps(_mm256_mul_ps(_mm256_set1_ps(w.w00), p00),
                                   _mm256_mul_ps(_mm256_set1_ps(w.w01), p01));
  return _mm256_add_ps(_mm256_add_ps(top, _mm256_mul_ps(_mm256_set1_ps(w.w10), p10)),
                       _mm256_mul_ps(_mm256_set1_ps(w.w11), p11));
}

/// Pixels of a row as floats: `eight` the first ones, `four` those behind them.
struct RowPixels {
  __m256 eight;
  __m256 four;  ///< in the low half

  OVERFLY_AVX2 static RowPixels at(const std::uint8_t* row) {
    std::int32_t last = 0;
    std::memcpy(&last, row + 8, sizeof(last));
    return {_mm256_cvtepi32_ps(
                _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(row)))),
            _mm256_castps128_ps256(_mm_cvtepi32_ps(_mm_cvtepu8_epi32(_mm_cvtsi32_si128(last))))};
  }
};

__attribute__((target("avx2"))) void shifted_avx2(const cv::Mat& image,
                                                  float x,
                                                  float y,
                                                  float* out) {
  static_assert(kPatchSize == 12);
  const int x0 = static_cast<int>(x);
  const int y0 = static_cast<int>(y);
  const FourWeights w(x - static_cast<float>(x0), y - static_cast<float>(y0));
  const std::uint8_t* row = image.ptr<std::uint8_t>(y0) + x0;
  RowPixels left = RowPixels::at(row);
  RowPixels right = RowPixels::at(row + 1);
  for (int i = 0; i < kPatchSize; ++i, out += kPatchSize) {
    row += image.step[0];
    const RowPixels below_left = RowPixels::at(row);
    const RowPixels below_right = RowPixels::at(row + 1);
    _mm256_storeu_ps(out,
                     weighted(w, left.eight, right.eight, below_left.eight, below_right.eight));
    _mm_storeu_ps(out + 8,
                  _mm256_castps256_ps128(
                      weighted(w, left.four, right.four, below_left.four, below_right.four)));
    left = below_left;
    right = below_right;
  }
}

#undef OVERFLY_AVX2

#endif

}  // namespace

const PatchSampler& plain_patch_sampler() {
  static constexpr PatchSampler kSampler{"plain", warped_plain, shifted_plain};
  return kSampler;
}

const PatchSampler& best_patch_sampler() {
#if defined(__x86_64__) && defined(__GNUC__)
  static constexpr PatchSampler kSampler{"avx2", warped_avx2, shifted_avx2};
  if (__builtin_cpu_supports("avx2")) return kSampler;
#endif
  return plain_patch_sampler();
}

}  // namespace overfly::odometry
