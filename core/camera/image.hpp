// Images as plain buffers, independent of image libraries.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace overfly {

/// Row-major interleaved image; row 0 is the top; no padding between rows.
template <typename T>
struct ImageBuffer {
  int width_px = 0;
  int height_px = 0;
  int channels = 1;  ///< 1 = grey (or one quantity), 3 = RGB
  std::vector<T> data;

  ImageBuffer() = default;
  ImageBuffer(int width, int height, int channel_count, T fill = T{})
      : width_px(width),
        height_px(height),
        channels(channel_count),
        data(static_cast<std::size_t>(width) * height * channel_count, fill) {}

  [[nodiscard]] bool empty() const { return data.empty(); }
  [[nodiscard]] T& at(int x, int y, int channel = 0) { return data[index(x, y, channel)]; }
  [[nodiscard]] const T& at(int x, int y, int channel = 0) const {
    return data[index(x, y, channel)];
  }

 private:
  [[nodiscard]] std::size_t index(int x, int y, int channel) const {
    return (static_cast<std::size_t>(y) * width_px + x) * channels + channel;
  }
};

using Image = ImageBuffer<std::uint8_t>;     ///< 8 bit, grey or RGB
using Image16 = ImageBuffer<std::uint16_t>;  ///< more than 8 bit, grey or RGB
/// Linear radiance, grey or RGB; 1 = white in the imagery.
using RadianceImage = ImageBuffer<float>;
using DepthImage = ImageBuffer<float>;  ///< z along the optical axis [m]; +infinity = sky

}  // namespace overfly
