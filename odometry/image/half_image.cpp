#include "odometry/image/half_image.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <vector>

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#endif

namespace overfly::odometry {

int count_saturated(const cv::Mat& image) {
  int count = 0;
  for (int y = 0; y < image.rows; ++y) {
    const std::uint8_t* row = image.ptr<std::uint8_t>(y);
    count += static_cast<int>(std::count_if(
        row, row + image.cols, [](std::uint8_t value) { return value >= kSaturatedLevel; }));
  }
  return count;
}

HalfImage halved_by_opencv(const cv::Mat& image) {
  HalfImage half;
  cv::pyrDown(image, half.image);
  half.saturated_px = count_saturated(image);
  return half;
}

#if defined(__x86_64__) && defined(__GNUC__)

#define OVERFLY_AVX2 __attribute__((target("avx2"), always_inline)) inline

namespace {

constexpr int kTaps = 5;
constexpr int kVector = 32;  ///< bytes
/// A vector of 16 results reads the pixels from 2 before its first to 3 behind its last one.
constexpr int kReadByVector = kVector + 2;

/// The place of a pixel beyond the image: mirrored at the centre of the outermost pixel.
int mirrored(int i, int size) {
  if (i < 0) return -i;
  return i < size ? i : 2 * (size - 1) - i;
}

OVERFLY_AVX2 __m256i load(const void* from) {
  return _mm256_loadu_si256(static_cast<const __m256i*>(from));
}

OVERFLY_AVX2 void store(void* to, __m256i values) {
  _mm256_storeu_si256(static_cast<__m256i*>(to), values);
}

/// The filter along a row at its even pixel 2 x: at most 16 * 255.
std::uint16_t filtered_at(const std::uint8_t* row, int columns, int x) {
  const auto pixel = [&](int i) { return row[mirrored(2 * x + i, columns)]; };
  return static_cast<std::uint16_t>(pixel(-2) + 4 * pixel(-1) + 6 * pixel(0) + 4 * pixel(1) +
                                    pixel(2));
}

/// 16 results of the filter along a row. @param first  pixel of the first result
OVERFLY_AVX2 __m256i sixteen_filtered(const std::uint8_t* first) {
  const __m256i before = _mm256_maddubs_epi16(load(first - 2), _mm256_set1_epi16(0x0401));  // 1, 4
  const __m256i at = _mm256_maddubs_epi16(load(first), _mm256_set1_epi16(0x0406));          // 6, 4
  const __m256i after = _mm256_and_si256(load(first + 2), _mm256_set1_epi16(255));
  return _mm256_add_epi16(_mm256_add_epi16(before, at), after);
}

/// @pre columns > kReadByVector
__attribute__((target("avx2"))) void filter_row(const std::uint8_t* row,
                                                int columns,
                                                std::uint16_t* out) {
  const int count = (columns + 1) / 2;
  out[0] = filtered_at(row, columns, 0);
  const int last = (columns - kReadByVector) / 2;  // result at which the last vector may begin
  for (int x = 1; x < last; x += 16) store(out + x, sixteen_filtered(row + 2 * x));
  store(out + last, sixteen_filtered(row + 2 * static_cast<std::ptrdiff_t>(last)));
  for (int x = last + 16; x < count; ++x) out[x] = filtered_at(row, columns, x);
}

__attribute__((target("avx2"))) int saturated_in_row(const std::uint8_t* row, int columns) {
  const __m256i least = _mm256_set1_epi8(static_cast<char>(kSaturatedLevel));
  __m256i sums = _mm256_setzero_si256();
  int x = 0;
  while (x + kVector <= columns) {
    __m256i counts = _mm256_setzero_si256();
    const int end = std::min(columns, x + 255 * kVector);  // counts are bytes
    for (; x + kVector <= end; x += kVector) {
      const __m256i pixels = load(row + x);
      counts = _mm256_sub_epi8(counts, _mm256_cmpeq_epi8(_mm256_max_epu8(pixels, least), pixels));
    }
    sums = _mm256_add_epi64(sums, _mm256_sad_epu8(counts, _mm256_setzero_si256()));
  }
  alignas(32) std::int64_t four[4];
  store(four, sums);
  auto count = static_cast<int>(four[0] + four[1] + four[2] + four[3]);
  for (; x < columns; ++x) count += row[x] >= kSaturatedLevel ? 1 : 0;
  return count;
}

/// 16 pixels of the half image from five filtered rows. The sum of all weights is 256: sums with
/// the rounding fit 16 bits.
OVERFLY_AVX2 __m256i sixteen_pixels(const std::uint16_t* const* rows, int x) {
  const __m256i outer = _mm256_add_epi16(load(rows[0] + x), load(rows[4] + x));
  const __m256i inner = _mm256_add_epi16(load(rows[1] + x), load(rows[3] + x));
  const __m256i middle = _mm256_mullo_epi16(load(rows[2] + x), _mm256_set1_epi16(6));
  const __m256i sum = _mm256_add_epi16(_mm256_add_epi16(outer, _mm256_slli_epi16(inner, 2)),
                                       _mm256_add_epi16(middle, _mm256_set1_epi16(128)));
  return _mm256_srli_epi16(sum, 8);
}

/// @param rows  with room for whole vectors
__attribute__((target("avx2"))) void combine_rows(const std::uint16_t* const* rows,
                                                  int columns,
                                                  std::uint8_t* out) {
  for (int x = 0; x < columns; x += kVector) {
    const __m256i pixels = _mm256_permute4x64_epi64(
        _mm256_packus_epi16(sixteen_pixels(rows, x), sixteen_pixels(rows, x + 16)),
        _MM_SHUFFLE(3, 1, 2, 0));
    if (x + kVector <= columns) {
      store(out + x, pixels);
    } else {
      std::uint8_t last[kVector];
      store(last, pixels);
      std::memcpy(out + x, last, static_cast<std::size_t>(columns - x));
    }
  }
}

HalfImage halved_by_avx2(const cv::Mat& image) {
  HalfImage half;
  half.image.create((image.rows + 1) / 2, (image.cols + 1) / 2, CV_8U);
  const auto room = static_cast<std::size_t>((half.image.cols + kVector - 1) / kVector * kVector);
  std::vector<std::uint16_t> ring(kTaps * room);
  const auto row_of = [&](int y) { return &ring[static_cast<std::size_t>(y % kTaps) * room]; };
  int filtered = 0;  // number of rows
  for (int y = 0; y < half.image.rows; ++y) {
    for (const int end = std::min(2 * y + 3, image.rows); filtered < end; ++filtered) {
      const std::uint8_t* row = image.ptr<std::uint8_t>(filtered);
      filter_row(row, image.cols, row_of(filtered));
      half.saturated_px += saturated_in_row(row, image.cols);
    }
    const std::uint16_t* rows[kTaps];
    for (int i = 0; i < kTaps; ++i) rows[i] = row_of(mirrored(2 * y + i - 2, image.rows));
    combine_rows(rows, half.image.cols, half.image.ptr<std::uint8_t>(y));
  }
  return half;
}

}  // namespace

#undef OVERFLY_AVX2

HalfImage halved(const cv::Mat& image) {
  const bool large = image.cols > 2 * kReadByVector && image.rows >= kTaps;
  if (large && __builtin_cpu_supports("avx2")) return halved_by_avx2(image);
  return halved_by_opencv(image);
}

#else

HalfImage halved(const cv::Mat& image) { return halved_by_opencv(image); }

#endif

}  // namespace overfly::odometry
