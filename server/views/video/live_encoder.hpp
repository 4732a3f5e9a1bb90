// Encodes the pictures of a stream as VP8 with libvpx, one by one, as they are shown.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/camera/image.hpp"
#include "core/result.hpp"

namespace overfly::server {

/// One compressed picture. All but key pictures need the one before.
struct LivePacket {
  std::vector<std::uint8_t> bytes;
  bool key = false;
};

/// Constant quality, one thread, no delay: each picture gives one packet. Luma and chroma have the
/// full range and the matrix of ITU-R BT.601; VP8 itself does not say so.
class LiveEncoder {
 public:
  /// @param width_px, height_px  in [1, 16383]
  /// Errors: kInvalidArgument naming field, value and limit; kInternal with libvpx's message.
  static Result<LiveEncoder> open(int width_px, int height_px);
  ~LiveEncoder();
  LiveEncoder(LiveEncoder&&) noexcept;
  LiveEncoder& operator=(LiveEncoder&&) noexcept;

  [[nodiscard]] int width_px() const;
  [[nodiscard]] int height_px() const;
  /// @param image  grey or RGB, of the encoder's size
  /// @param quality  as of a JPEG that differs as much from the image, in [1, 100]
  /// @param key  makes a key picture; the first one is one anyway
  [[nodiscard]] Result<LivePacket> encode(const Image& image, int quality, bool key);

 private:
  struct State;
  explicit LiveEncoder(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// VP8's quantiser, in [0, 63], for a picture as good as a JPEG of this quality.
[[nodiscard]] int quantiser_like_jpeg(int quality);

}  // namespace overfly::server
