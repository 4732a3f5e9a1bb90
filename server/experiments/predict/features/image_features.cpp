#include "server/experiments/predict/features/image_features.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

namespace overfly::server::predict {
namespace {

constexpr int kCircle = 16;
constexpr int kArc = 9;
constexpr int kCircleRadius = 3;
/// Bresenham's circle of radius 3, clockwise from the top.
constexpr std::array<std::array<int, 2>, kCircle> kOffsets = {{{0, -3},
                                                               {1, -3},
                                                               {2, -2},
                                                               {3, -1},
                                                               {3, 0},
                                                               {3, 1},
                                                               {2, 2},
                                                               {1, 3},
                                                               {0, 3},
                                                               {-1, 3},
                                                               {-2, 2},
                                                               {-3, 1},
                                                               {-3, 0},
                                                               {-3, -1},
                                                               {-2, -2},
                                                               {-1, -3}}};

/// True if 9 neighbouring bits of the circle are set.
bool has_arc(std::uint32_t bits) {
  std::uint32_t run = bits | (bits << kCircle);
  std::uint32_t arc = run;
  for (int i = 1; i < kArc; ++i) {
    run >>= 1U;
    arc &= run;
  }
  return arc != 0;
}

/// The corner's score; 0 = no corner.
int corner_score(const std::uint8_t* centre,
                 const std::array<std::ptrdiff_t, kCircle>& steps,
                 int threshold) {
  const int value = *centre;
  std::uint32_t brighter = 0;
  std::uint32_t darker = 0;
  int sum_brighter = 0;
  int sum_darker = 0;
  for (int i = 0; i < kCircle; ++i) {
    const int difference = centre[steps[static_cast<std::size_t>(i)]] - value;
    if (difference > threshold) {
      brighter |= 1U << static_cast<unsigned>(i);
      sum_brighter += difference - threshold;
    } else if (difference < -threshold) {
      darker |= 1U << static_cast<unsigned>(i);
      sum_darker += -difference - threshold;
    }
  }
  int score = 0;
  if (has_arc(brighter)) score = sum_brighter;
  if (has_arc(darker)) score = std::max(score, sum_darker);
  return score;
}

constexpr int kTemplateHalf = 6;
constexpr int kTemplateSide = 2 * kTemplateHalf + 1;
constexpr int kTemplatePixels = kTemplateSide * kTemplateSide;

/// A square of pixels around a centre: sums for the correlation.
struct Square {
  std::int64_t sum = 0;
  std::int64_t squares = 0;

  /// kTemplatePixels^2 times the variance.
  [[nodiscard]] double spread() const {
    return static_cast<double>(kTemplatePixels * squares - sum * sum);
  }
};

Square square_at(const Image& grey, int x, int y) {
  Square square;
  for (int dy = -kTemplateHalf; dy <= kTemplateHalf; ++dy) {
    const std::uint8_t* row = &grey.at(x - kTemplateHalf, y + dy);
    for (int dx = 0; dx < kTemplateSide; ++dx) {
      square.sum += row[dx];
      square.squares += std::int64_t{row[dx]} * row[dx];
    }
  }
  return square;
}

std::int64_t product_of(const Image& grey, int x1, int y1, int x2, int y2) {
  std::int64_t sum = 0;
  for (int dy = -kTemplateHalf; dy <= kTemplateHalf; ++dy) {
    const std::uint8_t* a = &grey.at(x1 - kTemplateHalf, y1 + dy);
    const std::uint8_t* b = &grey.at(x2 - kTemplateHalf, y2 + dy);
    std::int32_t row = 0;
    for (int dx = 0; dx < kTemplateSide; ++dx) row += a[dx] * b[dx];
    sum += row;
  }
  return sum;
}

/// The highest normalised cross-correlation of a template with the places around it; 1 if the
/// template has too little contrast.
double second_peak(const Image& grey, int x, int y, int radius_px, double least_contrast) {
  const Square own = square_at(grey, x, y);
  const double least = least_contrast * kTemplatePixels;
  if (own.spread() < least * least) return 1.0;
  double best = 0.0;
  for (int dy = -radius_px; dy <= radius_px; ++dy) {
    for (int dx = -radius_px; dx <= radius_px; ++dx) {
      if (std::abs(dx) <= kTemplateHalf && std::abs(dy) <= kTemplateHalf) continue;
      const Square other = square_at(grey, x + dx, y + dy);
      if (other.spread() <= 0.0) continue;
      const double common = static_cast<double>(
          kTemplatePixels * product_of(grey, x, y, x + dx, y + dy) - own.sum * other.sum);
      best = std::max(best, common / std::sqrt(own.spread() * other.spread()));
    }
  }
  return best;
}

}  // namespace

int count_corners(const Image& grey, int threshold) {
  const int width = grey.width_px;
  const int height = grey.height_px;
  if (width <= 2 * kCircleRadius || height <= 2 * kCircleRadius) return 0;
  std::array<std::ptrdiff_t, kCircle> steps{};
  for (std::size_t i = 0; i < steps.size(); ++i) {
    steps[i] = std::ptrdiff_t{kOffsets[i][1]} * width + kOffsets[i][0];
  }
  ImageBuffer<int> scores(width, height, 1);
  for (int y = kCircleRadius; y < height - kCircleRadius; ++y) {
    for (int x = kCircleRadius; x < width - kCircleRadius; ++x) {
      scores.at(x, y) = corner_score(&grey.at(x, y), steps, threshold);
    }
  }
  int corners = 0;
  for (int y = kCircleRadius; y < height - kCircleRadius; ++y) {
    for (int x = kCircleRadius; x < width - kCircleRadius; ++x) {
      const int score = scores.at(x, y);
      if (score == 0) continue;
      bool highest = true;
      for (int i = 0; i < 9 && highest; ++i) {
        const int other = scores.at(x + i % 3 - 1, y + i / 3 - 1);
        // Of equal neighbours the last one counts.
        highest = i <= 4 ? other <= score : other < score;
      }
      corners += highest ? 1 : 0;
    }
  }
  return corners;
}

std::optional<double> self_similarity(const Image& grey, int radius_px, double least_contrast) {
  const int margin = radius_px + kTemplateHalf;
  const int room_x = grey.width_px - 1 - 2 * margin;
  const int room_y = grey.height_px - 1 - 2 * margin;
  if (radius_px < 1 || room_x < 0 || room_y < 0) return std::nullopt;
  // One template, or four where they do not overlap.
  const int columns = room_x >= kTemplateSide ? 2 : 1;
  const int rows = room_y >= kTemplateSide ? 2 : 1;
  std::vector<double> peaks;
  for (int i = 0; i < columns * rows; ++i) {
    const int x = margin + (columns == 1 ? room_x / 2 : (i % columns) * room_x);
    const int y = margin + (rows == 1 ? room_y / 2 : (i / columns) * room_y);
    peaks.push_back(second_peak(grey, x, y, radius_px, least_contrast));
  }
  std::sort(peaks.begin(), peaks.end());
  return peaks[peaks.size() / 2];
}

int fitting_radius_px(const Image& grey, int radius_px) {
  const int side_px = std::min(grey.width_px, grey.height_px);
  return std::min(radius_px, (side_px - kTemplateSide) / 2);
}

double noise_of(const Image& first, const Image& second) {
  if (first.data.empty()) return 0.0;
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < first.data.size(); ++i) {
    const double difference = static_cast<double>(first.data[i]) - second.data[i];
    sum += difference;
    squares += difference * difference;
  }
  const auto count = static_cast<double>(first.data.size());
  const double mean = sum / count;
  return std::sqrt(std::max(0.0, squares / count - mean * mean) / 2.0);
}

}  // namespace overfly::server::predict
