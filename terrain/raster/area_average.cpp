#include "terrain/raster/area_average.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace overfly::terrain {
namespace {

/// The source texels under one result texel, with their weights.
struct Span {
  int begin = 0;
  std::vector<float> weights;
};

std::vector<Span> spans(double first, double step, int count, int source_size) {
  std::vector<Span> result(count);
  for (int i = 0; i < count; ++i) {
    const double low = std::max(0.0, first + i * step);
    const double high = std::min<double>(source_size, first + (i + 1) * step);
    constexpr double kHair = 1e-9;
    const int begin = static_cast<int>(std::floor(low + kHair));
    const int end = static_cast<int>(std::ceil(high - kHair));
    result[i].begin = begin;
    for (int k = begin; k < end; ++k) {
      const double share = std::min<double>(high, k + 1) - std::max<double>(low, k);
      result[i].weights.push_back(static_cast<float>(share));
    }
  }
  return result;
}

/// Integer factor, no offset: sums in integers.
Patch average_blocks(const Patch& source, int factor, int width, int height) {
  Patch result = void_patch(width, height);
  const int source_width = source.rgb.width_px;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      std::uint32_t sum[3] = {0, 0, 0};
      std::uint32_t count = 0;
      for (int v = 0; v < factor; ++v) {
        const std::size_t row =
            static_cast<std::size_t>(y * factor + v) * source_width + x * factor;
        const std::uint8_t* valid = source.valid.data.data() + row;
        const std::uint8_t* rgb = source.rgb.data.data() + row * 3;
        for (int u = 0; u < factor; ++u, rgb += 3) {
          if (valid[u] == 0) continue;
          sum[0] += rgb[0];
          sum[1] += rgb[1];
          sum[2] += rgb[2];
          ++count;
        }
      }
      if (count == 0 || 2 * count < static_cast<std::uint32_t>(factor * factor)) continue;
      for (int c = 0; c < 3; ++c) {
        result.rgb.at(x, y, c) = static_cast<std::uint8_t>((sum[c] + count / 2) / count);
      }
      result.valid.at(x, y) = 255;
    }
  }
  return result;
}

}  // namespace

Patch void_patch(int width, int height) {
  Patch patch{Image(width, height, 3), Image(width, height, 1)};
  for (std::size_t i = 0; i < patch.rgb.data.size(); ++i) patch.rgb.data[i] = kVoidRgb[i % 3];
  return patch;
}

Patch area_average(const Patch& source,
                   double first_x,
                   double step_x,
                   double first_y,
                   double step_y,
                   int width,
                   int height) {
  const int factor = static_cast<int>(step_x);
  if (first_x == 0.0 && first_y == 0.0 && step_x == factor && step_y == factor &&
      source.rgb.width_px >= width * factor && source.rgb.height_px >= height * factor) {
    return average_blocks(source, factor, width, height);
  }
  const std::vector<Span> columns = spans(first_x, step_x, width, source.rgb.width_px);
  const std::vector<Span> rows = spans(first_y, step_y, height, source.rgb.height_px);
  const float full_area = static_cast<float>(step_x * step_y);
  Patch result = void_patch(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      float sum[3] = {0, 0, 0};
      float area = 0;
      for (std::size_t v = 0; v < rows[y].weights.size(); ++v) {
        for (std::size_t u = 0; u < columns[x].weights.size(); ++u) {
          const int px = columns[x].begin + static_cast<int>(u);
          const int py = rows[y].begin + static_cast<int>(v);
          if (source.valid.at(px, py) == 0) continue;
          const float weight = rows[y].weights[v] * columns[x].weights[u];
          for (int c = 0; c < 3; ++c) sum[c] += weight * source.rgb.at(px, py, c);
          area += weight;
        }
      }
      if (2.0F * area < full_area) continue;
      for (int c = 0; c < 3; ++c) {
        result.rgb.at(x, y, c) = static_cast<std::uint8_t>(std::lround(sum[c] / area));
      }
      result.valid.at(x, y) = 255;
    }
  }
  return result;
}

}  // namespace overfly::terrain
