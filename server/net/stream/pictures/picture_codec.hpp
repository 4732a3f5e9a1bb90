// The binary header of a picture message (docs/PROTOCOL.md, "Pictures").
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace overfly::net {

inline constexpr std::size_t kPictureHeaderBytes = 60;
inline constexpr std::uint32_t kPictureMagic = 0x4C46564FU;  ///< "OVFL" in little-endian bytes
inline constexpr std::uint16_t kPictureVersion = 2;

enum class PictureEncoding : std::uint16_t { kJpegGrey = 1, kJpegColour = 2, kVp8 = 3 };

struct PictureHeader {
  std::uint32_t stream_id = 0;
  std::uint32_t sequence = 0;
  std::int64_t frame = 0;
  std::int64_t t_ns = 0;
  std::uint16_t width_px = 0;
  std::uint16_t height_px = 0;
  PictureEncoding encoding = PictureEncoding::kJpegColour;
  std::uint32_t payload_bytes = 0;
  bool live = false;
  bool key = true;  ///< does not need the video picture before
  /// The values at the ends of the colours, of depth and error pictures.
  struct Scale {
    float low = 0.0F;
    float high = 0.0F;
    bool logarithmic = false;
    bool operator==(const Scale&) const = default;
  };
  std::optional<Scale> scale;
  std::uint16_t full_width_px = 0;  ///< of the image before it was reduced
  std::uint16_t full_height_px = 0;
};

[[nodiscard]] std::array<std::uint8_t, kPictureHeaderBytes> encode_picture_header(
    const PictureHeader& header);

/// Empty if magic, version, type, lengths or encoding are not those of a complete picture message.
[[nodiscard]] std::optional<PictureHeader> decode_picture_header(
    std::span<const std::uint8_t> message);

}  // namespace overfly::net
