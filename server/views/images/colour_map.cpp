#include "server/views/images/colour_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <tuple>
#include <vector>

#include "server/camera/camera_shot.hpp"

namespace overfly::server {
namespace {

using Rgb = std::array<std::uint8_t, 3>;
using Anchors = std::array<Rgb, 9>;
using Table = std::array<Rgb, 256>;

/// From far to near.
constexpr Anchors kDepthAnchors = {{{41, 19, 91},
                                    {26, 50, 130},
                                    {0, 86, 157},
                                    {0, 123, 166},
                                    {0, 157, 159},
                                    {0, 184, 143},
                                    {115, 205, 129},
                                    {192, 221, 132},
                                    {250, 237, 161}}};
/// From negative to positive.
constexpr Anchors kDifferenceAnchors = {{{128, 195, 255},
                                         {80, 146, 212},
                                         {49, 99, 149},
                                         {35, 56, 79},
                                         {18, 18, 18},
                                         {76, 47, 21},
                                         {142, 78, 0},
                                         {204, 117, 24},
                                         {255, 166, 85}}};
constexpr Rgb kSky = {118, 118, 122};

Table colours_between(const Anchors& anchors) {
  Table table{};
  constexpr std::size_t kSteps = std::tuple_size_v<Anchors> - 1;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double at = static_cast<double>(i * kSteps) / static_cast<double>(table.size() - 1);
    const std::size_t below = std::min(static_cast<std::size_t>(at), kSteps - 1);
    const double share = at - static_cast<double>(below);
    for (std::size_t c = 0; c < 3; ++c) {
      table[i][c] = static_cast<std::uint8_t>(
          std::lround((1.0 - share) * anchors[below][c] + share * anchors[below + 1][c]));
    }
  }
  return table;
}

/// 1, 2 or 5 times a power of ten, not above `value` > 0.
double round_step(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  const double mantissa = value / decade;
  return decade * (mantissa >= 5.0 ? 5.0 : mantissa >= 2.0 ? 2.0 : 1.0);
}

/// Applies `colour_of` to each value.
template <typename T, typename ColourOf>
Image coloured(const ImageBuffer<T>& values, const ColourOf& colour_of) {
  Image image(values.width_px, values.height_px, 3);
  std::uint8_t* out = image.data.data();
  for (const T value : values.data) {
    const Rgb& rgb = colour_of(value);
    out = std::copy(rgb.begin(), rgb.end(), out);
  }
  return image;
}

}  // namespace

ColourScale depth_scale(const DepthImage& depth) {
  constexpr std::size_t kEvery = 7;
  constexpr double kFarShare = 0.98;
  constexpr double kMostForLinear = 8.0;
  std::vector<float> seen;
  for (std::size_t i = 0; i < depth.data.size(); i += kEvery) {
    if (std::isfinite(depth.data[i]) && depth.data[i] > 0.0F) seen.push_back(depth.data[i]);
  }
  if (seen.empty()) return {};
  const double nearest = *std::min_element(seen.begin(), seen.end());
  const auto far_at = static_cast<std::ptrdiff_t>(kFarShare * static_cast<double>(seen.size() - 1));
  std::nth_element(seen.begin(), seen.begin() + far_at, seen.end());
  const double far = std::max<double>(seen[static_cast<std::size_t>(far_at)], nearest);
  ColourScale scale;
  scale.logarithmic = far > kMostForLinear * nearest;
  // Round ends, so that the colours of a flight at a constant height do not flicker.
  const double low_step = scale.logarithmic ? round_step(nearest) : round_step(0.05 * far);
  const double high_step = scale.logarithmic ? round_step(far) : low_step;
  scale.low = low_step * std::floor(nearest / low_step);
  scale.high = high_step * std::ceil(far / high_step);
  if (scale.high <= scale.low) scale.high = scale.low + high_step;
  return scale;
}

Image coloured_depth(const DepthImage& depth, const ColourScale& scale) {
  static const Table kTable = colours_between(kDepthAnchors);
  const auto place = [&](float value) {
    return scale.logarithmic ? std::log(value) : static_cast<double>(value);
  };
  const double low = place(static_cast<float>(scale.low));
  const double span = place(static_cast<float>(scale.high)) - low;
  return coloured(depth, [&](float value) -> const Rgb& {
    if (!std::isfinite(value) || !(span > 0.0)) return kSky;
    const double share = 1.0 - (place(value) - low) / span;
    return kTable[static_cast<std::size_t>(std::lround(255.0 * std::clamp(share, 0.0, 1.0)))];
  });
}

ImageBuffer<std::int16_t> grey_difference(const Image& a, const Image& b) {
  const auto grey = [](const Image& image, Image& made) -> const Image& {
    if (image.channels == 1) return image;
    made = grey_of(image);
    return made;
  };
  Image made_a, made_b;
  const Image& grey_a = grey(a, made_a);
  const Image& grey_b = grey(b, made_b);
  ImageBuffer<std::int16_t> difference(a.width_px, a.height_px, 1);
  std::transform(grey_a.data.begin(),
                 grey_a.data.end(),
                 grey_b.data.begin(),
                 difference.data.begin(),
                 [](int x, int y) { return static_cast<std::int16_t>(x - y); });
  return difference;
}

ColourScale difference_scale(const ImageBuffer<std::int16_t>& difference) {
  constexpr double kShare = 0.98;
  constexpr int kLeast = 4;
  std::array<std::size_t, 256> counts{};
  for (const std::int16_t value : difference.data) {
    ++counts[static_cast<std::size_t>(std::min(std::abs(static_cast<int>(value)), 255))];
  }
  const auto wanted =
      static_cast<std::size_t>(kShare * static_cast<double>(difference.data.size()));
  std::size_t below = 0;
  int level = 0;
  while (level < 255 && (below += counts[static_cast<std::size_t>(level)]) < wanted) ++level;
  int limit = kLeast;
  while (limit < level) limit *= 2;
  return {-static_cast<double>(limit), static_cast<double>(limit), false};
}

Image coloured_difference(const ImageBuffer<std::int16_t>& difference, const ColourScale& scale) {
  static const Table kTable = colours_between(kDifferenceAnchors);
  const double span = scale.high - scale.low;
  return coloured(difference, [&](std::int16_t value) -> const Rgb& {
    const double share = (value - scale.low) / span;
    return kTable[static_cast<std::size_t>(std::lround(255.0 * std::clamp(share, 0.0, 1.0)))];
  });
}

}  // namespace overfly::server
