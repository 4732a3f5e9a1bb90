#include "terrain/imagery/resample.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace overfly::terrain {
namespace {

/// Keys' kernel with a = -0.5.
double cubic(double t) {
  t = std::abs(t);
  if (t < 1.0) return (1.5 * t - 2.5) * t * t + 1.0;
  if (t < 2.0) return ((-0.5 * t + 2.5) * t - 4.0) * t + 2.0;
  return 0.0;
}

/// Kernel weights of one axis around a place, tabulated over its fraction of a texel: the mean of
/// `count` cubic interpolations that share a texel of the result of width `width`.
class Kernel {
 public:
  Kernel(double width, int count)
      : taps_(2 * static_cast<int>(std::ceil(2.0 + 0.5 * width * (count - 1) / count))) {
    weights_.resize(static_cast<std::size_t>(kSteps + 1) * taps_);
    for (int step = 0; step <= kSteps; ++step) {
      const double fraction = static_cast<double>(step) / kSteps;
      float* weights = &weights_[static_cast<std::size_t>(step) * taps_];
      double sum = 0.0;
      for (int k = 0; k < taps_; ++k) {
        const int offset = k - (taps_ / 2 - 1);
        const double distance = offset - fraction;
        double weight = 0.0;
        for (int i = 0; i < count; ++i) {
          weight += cubic(distance - width * ((i + 0.5) / count - 0.5));
        }
        weights[k] = static_cast<float>(weight);
        sum += weight;
      }
      for (int k = 0; k < taps_; ++k) weights[k] /= static_cast<float>(sum);
    }
  }

  /// @param width  of the result's texel, in texels of the level that is read
  /// @param base   of a texel of the result's level 0, in file pixels
  static Kernel across(double width, double base) {
    // If level 0 magnifies, it interpolates at texel centres, and a coarser level is the mean of
    // the same interpolations. If level 0 reduces, the interpolations are spread evenly over its
    // texel.
    const double spacing = base <= 1.0 + 1e-6 ? base : 0.25;
    return {width, std::max(1, static_cast<int>(std::lround(width / spacing)))};
  }

  [[nodiscard]] int taps() const { return taps_; }
  /// First texel of the taps and their weights, for a position with texel centres at integers.
  const float* at(double place, int& first) const {
    const double base = std::floor(place);
    first = static_cast<int>(base) - (taps_ / 2 - 1);
    const auto step = static_cast<int>(std::lround((place - base) * kSteps));
    return weights_.data() + static_cast<std::size_t>(step) * taps_;
  }

 private:
  static constexpr int kSteps = 256;
  int taps_;
  std::vector<float> weights_;
};

/// Red, green, blue and 1: one vector register, so that a tap costs one multiplication and one
/// addition.
using Texel [[gnu::vector_size(16)]] = float;

/// @param x, y  place in the source, with texel centres at integers
void sample(const Patch& source,
            double x,
            double y,
            const Kernel& kernel_x,
            const Kernel& kernel_y,
            std::uint8_t* rgb,
            std::uint8_t* valid) {
  int first_x = 0;
  int first_y = 0;
  const float* weights_x = kernel_x.at(x, first_x);
  const float* weights_y = kernel_y.at(y, first_y);
  const int begin_x = std::max(0, -first_x);
  const int end_x = std::min(kernel_x.taps(), source.rgb.width_px - first_x);
  const int begin_y = std::max(0, -first_y);
  const int end_y = std::min(kernel_y.taps(), source.rgb.height_px - first_y);
  Texel sum{0, 0, 0, 0};
  for (int j = begin_y; j < end_y; ++j) {
    const std::ptrdiff_t row =
        static_cast<std::ptrdiff_t>(first_y + j) * source.rgb.width_px + first_x;
    const std::uint8_t* texels = source.rgb.data.data() + 3 * row;
    const std::uint8_t* is_valid = source.valid.data.data() + row;
    for (int i = begin_x; i < end_x; ++i) {
      if (is_valid[i] == 0) continue;
      const std::uint8_t* texel = texels + 3 * i;
      sum += weights_x[i] * weights_y[j] *
             Texel{static_cast<float>(texel[0]),
                   static_cast<float>(texel[1]),
                   static_cast<float>(texel[2]),
                   1.0F};
    }
  }
  const float total = sum[3];
  if (total < 0.5F) return;
  for (int c = 0; c < 3; ++c) {
    rgb[c] = static_cast<std::uint8_t>(std::clamp(sum[c] / total + 0.5F, 0.0F, 255.0F));
  }
  *valid = 255;
}

}  // namespace

Result<Patch> resample(const ImageryRaster& raster,
                       const Eigen::Matrix2Xd& pixels,
                       const Eigen::Vector2d& base_px,
                       int result_level,
                       int width,
                       int height,
                       const Cancelled& cancelled) {
  const Eigen::Vector2d size_px = base_px * std::pow(2.0, result_level);
  const int level = std::max(0, static_cast<int>(std::floor(std::log2(size_px.minCoeff() + 1e-9))));
  const double scale = std::pow(2.0, -level);
  const Kernel kernel_x = Kernel::across(size_px.x() * scale, base_px.x());
  const Kernel kernel_y = Kernel::across(size_px.y() * scale, base_px.y());

  // The window of the file that the result needs, clipped to the file.
  const double reach_x = (kernel_x.taps() + 1) / scale;
  const double reach_y = (kernel_y.taps() + 1) / scale;
  Eigen::Vector2d low(1e18, 1e18);
  Eigen::Vector2d high(-1e18, -1e18);
  for (Eigen::Index i = 0; i < pixels.cols(); ++i) {
    const double x = pixels(0, i);
    const double y = pixels(1, i);
    if (x < -reach_x || y < -reach_y || x > raster.width_px() + reach_x ||
        y > raster.height_px() + reach_y) {
      continue;
    }
    low = low.cwiseMin(pixels.col(i));
    high = high.cwiseMax(pixels.col(i));
  }
  Patch result = void_patch(width, height);
  if (low.x() > high.x()) return result;
  const int left = static_cast<int>(std::floor(low.x() * scale)) - kernel_x.taps();
  const int top = static_cast<int>(std::floor(low.y() * scale)) - kernel_y.taps();
  const int right = static_cast<int>(std::ceil(high.x() * scale)) + kernel_x.taps();
  const int bottom = static_cast<int>(std::ceil(high.y() * scale)) + kernel_y.taps();
  const auto source = raster.read(level, left, top, right - left, bottom - top, cancelled);
  if (!source) return source.error();
  for (Eigen::Index i = 0; i < pixels.cols(); ++i) {
    const double x = pixels(0, i) * scale - 0.5 - left;
    const double y = pixels(1, i) * scale - 0.5 - top;
    if (!(x > -kernel_x.taps() && y > -kernel_y.taps() && x < right - left + kernel_x.taps() &&
          y < bottom - top + kernel_y.taps())) {
      continue;
    }
    sample(*source, x, y, kernel_x, kernel_y, &result.rgb.data[3 * i], &result.valid.data[i]);
  }
  return result;
}

}  // namespace overfly::terrain
