#include "odometry/feature/fast_corners.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <opencv2/features2d.hpp>

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#endif

namespace overfly::odometry::feature {

void find_fast_corners_by_opencv(const cv::Mat& image,
                                 const cv::Rect& cell,
                                 std::span<const int> thresholds,
                                 std::vector<FastCorner>& out) {
  out.clear();
  const cv::Rect read(cell.x - kFastReachPx,
                      cell.y - kFastReachPx,
                      cell.width + 2 * kFastReachPx,
                      cell.height + 2 * kFastReachPx);
  std::vector<cv::KeyPoint> found;
  for (const int threshold : thresholds) {
    cv::FAST(image(read), found, threshold, true);
    if (!found.empty()) break;
  }
  for (const cv::KeyPoint& keypoint : found) {
    out.push_back({cv::Point(keypoint.pt) + read.tl(), static_cast<int>(keypoint.response)});
  }
}

#if defined(__x86_64__) && defined(__GNUC__)

#define OVERFLY_AVX2 __attribute__((target("avx2"), always_inline)) inline

namespace {

struct Offset {
  int x, y;
};

/// The circle of 16 pixels around the centre, in order.
constexpr std::array<Offset, 16> kCircle{{{0, 3},
                                          {1, 3},
                                          {2, 2},
                                          {3, 1},
                                          {3, 0},
                                          {3, -1},
                                          {2, -2},
                                          {1, -3},
                                          {0, -3},
                                          {-1, -3},
                                          {-2, -2},
                                          {-3, -1},
                                          {-3, 0},
                                          {-3, 1},
                                          {-2, 2},
                                          {-1, 3}}};

OVERFLY_AVX2 __m256i load_pixels(const std::uint8_t* from) {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
}

/// The largest value that nine neighbours on the circle reach. Each nine contain eight that begin
/// at an odd place, and one more on either side.
OVERFLY_AVX2 __m256i best_of_nine(const __m256i* d) {
  __m256i two[8], four[8];
  for (int k = 0; k < 8; ++k) two[k] = _mm256_min_epu8(d[2 * k + 1], d[(2 * k + 2) & 15]);
  for (int k = 0; k < 8; ++k) four[k] = _mm256_min_epu8(two[k], two[(k + 1) & 7]);
  __m256i best = _mm256_setzero_si256();
  for (int k = 0; k < 8; ++k) {
    const __m256i eight = _mm256_min_epu8(four[k], four[(k + 2) & 7]);
    const __m256i end = _mm256_max_epu8(d[2 * k], d[(2 * k + 9) & 15]);
    best = _mm256_max_epu8(best, _mm256_min_epu8(eight, end));
  }
  return best;
}

/// For 32 pixels the score plus 1; 0 = at no threshold a corner.
OVERFLY_AVX2 __m256i strengths(const std::uint8_t* pixels, std::ptrdiff_t stride) {
  const __m256i centre = load_pixels(pixels);
  __m256i brighter[16], darker[16];
  for (std::size_t k = 0; k < 16; ++k) {
    const __m256i around = load_pixels(pixels + kCircle[k].y * stride + kCircle[k].x);
    brighter[k] = _mm256_subs_epu8(around, centre);
    darker[k] = _mm256_subs_epu8(centre, around);
  }
  return _mm256_max_epu8(best_of_nine(brighter), best_of_nine(darker));
}

/// The strengths of a cell with zeros around it.
struct Strengths {
  static constexpr int kStride = kFastCellPx + 2;
  /// With room for the vectors of the last row.
  std::array<std::uint8_t, static_cast<std::size_t>(kStride) * (kFastCellPx + 3)> values{};

  std::uint8_t* row(int y) { return &values[static_cast<std::size_t>((y + 1) * kStride + 1)]; }
};

/// Bit x is set if the pixel is stronger than its eight neighbours.
OVERFLY_AVX2 std::uint32_t local_maxima(const std::uint8_t* row) {
  constexpr int kStride = Strengths::kStride;
  const auto pair = [&](int dx, int dy) __attribute__((target("avx2"))) {
    return _mm256_max_epu8(load_pixels(row + dy * kStride + dx),
                           load_pixels(row - dy * kStride - dx));
  };
  const __m256i around = _mm256_max_epu8(_mm256_max_epu8(pair(1, 0), pair(0, 1)),
                                         _mm256_max_epu8(pair(1, 1), pair(-1, 1)));
  const __m256i not_above =
      _mm256_cmpeq_epi8(_mm256_subs_epu8(load_pixels(row), around), _mm256_setzero_si256());
  return ~static_cast<std::uint32_t>(_mm256_movemask_epi8(not_above));
}

__attribute__((target("avx2"))) void find_by_avx2(const cv::Mat& image,
                                                  const cv::Rect& cell,
                                                  std::span<const int> thresholds,
                                                  std::vector<FastCorner>& out) {
  static_assert(kFastCellPx == 32);
  out.clear();
  const auto stride = static_cast<std::ptrdiff_t>(image.step[0]);
  const std::uint32_t in_cell = ~std::uint32_t{0} >> (32 - cell.width);
  Strengths strengths_of;
  for (int y = 0; y < cell.height; ++y) {
    const std::uint8_t* pixels = image.ptr<std::uint8_t>(cell.y + y) + cell.x;
    std::uint8_t* to = strengths_of.row(y);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), strengths(pixels, stride));
    for (int x = cell.width; x < kFastCellPx; ++x) to[x] = 0;
  }
  int highest = 0;
  for (int y = 0; y < cell.height; ++y) {
    const std::uint8_t* row = strengths_of.row(y);
    for (std::uint32_t left = local_maxima(row) & in_cell; left != 0; left &= left - 1) {
      const int x = std::countr_zero(left);
      const int score = row[x] - 1;
      if (score < thresholds.back()) continue;
      highest = std::max(highest, score);
      out.push_back({{cell.x + x, cell.y + y}, score});
    }
  }
  for (const int threshold : thresholds) {
    if (highest < threshold) continue;
    std::erase_if(out, [&](const FastCorner& corner) { return corner.score < threshold; });
    return;
  }
}

}  // namespace

#undef OVERFLY_AVX2

void find_fast_corners(const cv::Mat& image,
                       const cv::Rect& cell,
                       std::span<const int> thresholds,
                       std::vector<FastCorner>& out) {
  // Vectors read beyond a narrow cell: at the end of a row, that of the next ones.
  const std::ptrdiff_t last_row = cell.y + cell.height - 1 + kFastReachPx;
  const std::ptrdiff_t end = cell.x + kFastCellPx + kFastReachPx;
  const auto stride = static_cast<std::ptrdiff_t>(image.step[0]);
  const bool inside = last_row * stride + end <= (image.rows - 1) * stride + image.cols;
  if (inside && __builtin_cpu_supports("avx2")) {
    return find_by_avx2(image, cell, thresholds, out);
  }
  find_fast_corners_by_opencv(image, cell, thresholds, out);
}

#else

void find_fast_corners(const cv::Mat& image,
                       const cv::Rect& cell,
                       std::span<const int> thresholds,
                       std::vector<FastCorner>& out) {
  find_fast_corners_by_opencv(image, cell, thresholds, out);
}

#endif

}  // namespace overfly::odometry::feature
