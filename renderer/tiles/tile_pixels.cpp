#include "renderer/tiles/tile_pixels.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "renderer/tiles/srgb.hpp"

namespace overfly::renderer {

namespace {

constexpr int kValidStep = 8;

Image thinned(const Image& valid) {
  const bool all_valid =
      std::all_of(valid.data.begin(), valid.data.end(), [](auto value) { return value != 0; });
  if (all_valid) return {};
  Image thin(valid.width_px / kValidStep, valid.height_px / kValidStep, 1);
  for (int y = 0; y < thin.height_px; ++y) {
    for (int x = 0; x < thin.width_px; ++x) {
      thin.at(x, y) = valid.at(x * kValidStep + kValidStep / 2, y * kValidStep + kValidStep / 2);
    }
  }
  return thin;
}

/// @tparam Channels  of the image, a constant so that the loops are optimised
template <int Channels, typename T>
void halve_rows(const ImageBuffer<T>& image, ImageBuffer<T>& half) {
  const std::size_t right = image.width_px > 1 ? Channels : 0;
  const std::size_t down =
      image.height_px > 1 ? static_cast<std::size_t>(image.width_px) * Channels : 0;
  for (int y = 0; y < half.height_px; ++y) {
    const T* from = &image.at(0, std::min(2 * y, image.height_px - 1));
    T* to = &half.at(0, y);
    for (int x = 0; x < half.width_px; ++x, from += 2 * Channels, to += Channels) {
      for (int c = 0; c < Channels; ++c) {
        const std::uint32_t sum = static_cast<std::uint32_t>(from[c]) + from[c + right] +
                                  from[c + down] + from[c + right + down];
        to[c] = static_cast<T>((sum + 2U) / 4U);
      }
    }
  }
}

template <typename T>
ImageBuffer<T> halved(const ImageBuffer<T>& image) {
  ImageBuffer<T> half(
      std::max(image.width_px / 2, 1), std::max(image.height_px / 2, 1), image.channels);
  switch (image.channels) {
    case 1:
      halve_rows<1>(image, half);
      break;
    case 3:
      halve_rows<3>(image, half);
      break;
    default:
      halve_rows<4>(image, half);
      break;
  }
  return half;
}

template <typename T>
std::vector<ImageBuffer<T>> chain(ImageBuffer<T> level_0) {
  std::vector<ImageBuffer<T>> levels;
  levels.push_back(std::move(level_0));
  while (levels.back().width_px > 1 || levels.back().height_px > 1) {
    levels.push_back(halved(levels.back()));
  }
  return levels;
}

std::array<std::uint16_t, 256> make_linear_from_srgb() {
  std::array<std::uint16_t, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double light = light_from_srgb(static_cast<double>(i) / 255.0);
    table[i] = static_cast<std::uint16_t>(std::lround(65535.0 * light));
  }
  return table;
}

}  // namespace

Image grey_from_rgb(const Image& rgb) {
  Image grey(rgb.width_px, rgb.height_px, 1);
  for (std::size_t i = 0; i < grey.data.size(); ++i) {
    const std::uint8_t* p = &rgb.data[3 * i];
    grey.data[i] = static_cast<std::uint8_t>((77 * p[0] + 150 * p[1] + 29 * p[2] + 128) / 256);
  }
  return grey;
}

Image with_alpha(const Image& rgb, const Image& alpha) {
  Image rgba(rgb.width_px, rgb.height_px, 4);
  for (std::size_t i = 0; i < alpha.data.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) rgba.data[4 * i + c] = rgb.data[3 * i + c];
    rgba.data[4 * i + 3] = alpha.data[i];
  }
  return rgba;
}

const std::array<std::uint16_t, 256>& linear_from_srgb() {
  static const std::array<std::uint16_t, 256> kTable = make_linear_from_srgb();
  return kTable;
}

Image16 linear_grey_from_rgb(const Image& rgb) {
  const auto& linear = linear_from_srgb();
  Image16 grey(rgb.width_px, rgb.height_px, 1);
  for (std::size_t i = 0; i < grey.data.size(); ++i) {
    const std::uint8_t* p = &rgb.data[3 * i];
    // 0.2126, 0.7152, 0.0722; together 65536.
    const std::uint32_t sum =
        13933U * linear[p[0]] + 46871U * linear[p[1]] + 4732U * linear[p[2]] + 32768U;
    grey.data[i] = static_cast<std::uint16_t>(sum >> 16U);
  }
  return grey;
}

Image16 linear_with_alpha(const Image& rgb, const Image& alpha) {
  const auto& linear = linear_from_srgb();
  Image16 rgba(rgb.width_px, rgb.height_px, 4);
  for (std::size_t i = 0; i < alpha.data.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) rgba.data[4 * i + c] = linear[rgb.data[3 * i + c]];
    rgba.data[4 * i + 3] = alpha.data[i] != 0 ? 65535 : 0;
  }
  return rgba;
}

std::vector<Image> mip_chain(Image level_0) { return chain(std::move(level_0)); }

std::vector<Image16> mip_chain(Image16 level_0) { return chain(std::move(level_0)); }

std::size_t TilePixels::bytes() const {
  std::size_t sum = valid.data.size();
  for (const Image& level : levels) sum += level.data.size();
  for (const Image16& level : linear_levels) sum += level.data.size() * sizeof(std::uint16_t);
  return sum;
}

bool TilePixels::has_imagery(double u, double v) const {
  if (valid.empty()) return true;
  const int x = std::clamp(static_cast<int>(u * valid.width_px), 0, valid.width_px - 1);
  const int y = std::clamp(static_cast<int>(v * valid.height_px), 0, valid.height_px - 1);
  return valid.at(x, y) != 0;
}

TilePixels tile_pixels_from(const terrain::Tile& tile, PixelFormat format) {
  TilePixels pixels;
  pixels.valid = thinned(tile.valid);
  switch (format) {
    case PixelFormat::kGrey8:
      pixels.levels = mip_chain(grey_from_rgb(tile.rgb));
      break;
    case PixelFormat::kRgb8:
      pixels.levels = mip_chain(with_alpha(tile.rgb, tile.valid));
      break;
    case PixelFormat::kGreyLinear:
      pixels.linear_levels = mip_chain(linear_grey_from_rgb(tile.rgb));
      break;
    case PixelFormat::kRgbLinear:
      pixels.linear_levels = mip_chain(linear_with_alpha(tile.rgb, tile.valid));
      break;
  }
  return pixels;
}

}  // namespace overfly::renderer
