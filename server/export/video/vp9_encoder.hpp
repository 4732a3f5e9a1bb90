// Encodes RGB images as VP9 with libvpx.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/camera/image.hpp"
#include "core/result.hpp"

namespace overfly::server {

struct VideoSettings {
  int width_px = 0;   ///< even, in [16, 16384]
  int height_px = 0;  ///< even, in [16, 16384]
  int quality = 70;   ///< [1, 100]: 50 small, 70 clean, 90 near the original
  /// Maximum distance between key images, in images.
  int key_every = 64;
};

/// One compressed image.
struct VideoPacket {
  std::vector<std::uint8_t> bytes;
  std::int64_t t_ms = 0;
  bool key = false;  ///< decodes without the preceding ones
};

/// Constant quality, one thread, no lag: the same images give the same bytes.
class Vp9Encoder {
 public:
  /// Errors: kInvalidArgument naming field, value and limit; kInternal with libvpx's message.
  static Result<Vp9Encoder> open(const VideoSettings& settings);
  ~Vp9Encoder();
  Vp9Encoder(Vp9Encoder&&) noexcept;
  Vp9Encoder& operator=(Vp9Encoder&&) noexcept;

  /// @param rgb  of the settings' size, 3 channels
  /// @param t_ms  increasing
  /// Errors: kInvalidArgument for an image of another size or a stamp that does not increase;
  /// kInternal.
  [[nodiscard]] Result<std::vector<VideoPacket>> encode(const Image& rgb, std::int64_t t_ms);

 private:
  struct State;
  explicit Vp9Encoder(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Luma and two chroma planes at half resolution.
struct PlanarImage {
  int width_px = 0;   ///< even
  int height_px = 0;  ///< even
  std::vector<std::uint8_t> y, u, v;
};

/// ITU-R BT.709 in the narrow range (luma 16 to 235), chroma the mean of 2 x 2 pixels.
[[nodiscard]] PlanarImage planar_from_rgb(const Image& rgb);

}  // namespace overfly::server
