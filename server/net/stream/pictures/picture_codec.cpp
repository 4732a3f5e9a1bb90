#include "server/net/stream/pictures/picture_codec.hpp"

#include <bit>
#include <type_traits>

namespace overfly::net {
namespace {

constexpr std::uint16_t kTypePicture = 1;
constexpr std::uint32_t kFlagLive = 1U;
constexpr std::uint32_t kFlagScale = 2U;
constexpr std::uint32_t kFlagLogarithmic = 4U;
constexpr std::uint32_t kFlagKey = 8U;

// Offsets in the header.
constexpr std::size_t kMagicAt = 0;
constexpr std::size_t kVersionAt = 4;
constexpr std::size_t kTypeAt = 6;
constexpr std::size_t kStreamAt = 8;
constexpr std::size_t kSequenceAt = 12;
constexpr std::size_t kFrameAt = 16;
constexpr std::size_t kTimeAt = 24;
constexpr std::size_t kWidthAt = 32;
constexpr std::size_t kHeightAt = 34;
constexpr std::size_t kEncodingAt = 36;
constexpr std::size_t kHeaderLengthAt = 38;
constexpr std::size_t kPayloadLengthAt = 40;
constexpr std::size_t kFlagsAt = 44;
constexpr std::size_t kScaleLowAt = 48;
constexpr std::size_t kScaleHighAt = 52;
constexpr std::size_t kFullWidthAt = 56;
constexpr std::size_t kFullHeightAt = 58;

template <typename T>
void put(std::array<std::uint8_t, kPictureHeaderBytes>* bytes, std::size_t at, T value) {
  auto bits = static_cast<std::make_unsigned_t<T>>(value);
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    (*bytes)[at + i] = static_cast<std::uint8_t>((static_cast<std::uint64_t>(bits) >> (8 * i)));
  }
}

template <typename T>
T get(std::span<const std::uint8_t> bytes, std::size_t at) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    bits |= static_cast<std::uint64_t>(bytes[at + i]) << (8 * i);
  }
  return static_cast<T>(bits);
}

}  // namespace

std::array<std::uint8_t, kPictureHeaderBytes> encode_picture_header(const PictureHeader& header) {
  std::array<std::uint8_t, kPictureHeaderBytes> bytes{};
  put(&bytes, kMagicAt, kPictureMagic);
  put(&bytes, kVersionAt, kPictureVersion);
  put(&bytes, kTypeAt, kTypePicture);
  put(&bytes, kStreamAt, header.stream_id);
  put(&bytes, kSequenceAt, header.sequence);
  put(&bytes, kFrameAt, header.frame);
  put(&bytes, kTimeAt, header.t_ns);
  put(&bytes, kWidthAt, header.width_px);
  put(&bytes, kHeightAt, header.height_px);
  put(&bytes, kEncodingAt, static_cast<std::uint16_t>(header.encoding));
  put(&bytes, kHeaderLengthAt, static_cast<std::uint16_t>(kPictureHeaderBytes));
  put(&bytes, kPayloadLengthAt, header.payload_bytes);
  std::uint32_t flags = (header.live ? kFlagLive : 0U) | (header.key ? kFlagKey : 0U);
  if (header.scale) {
    flags |= kFlagScale | (header.scale->logarithmic ? kFlagLogarithmic : 0U);
    put(&bytes, kScaleLowAt, std::bit_cast<std::uint32_t>(header.scale->low));
    put(&bytes, kScaleHighAt, std::bit_cast<std::uint32_t>(header.scale->high));
  }
  put(&bytes, kFlagsAt, flags);
  put(&bytes, kFullWidthAt, header.full_width_px);
  put(&bytes, kFullHeightAt, header.full_height_px);
  return bytes;
}

std::optional<PictureHeader> decode_picture_header(std::span<const std::uint8_t> message) {
  if (message.size() < kPictureHeaderBytes) return std::nullopt;
  if (get<std::uint32_t>(message, kMagicAt) != kPictureMagic) return std::nullopt;
  if (get<std::uint16_t>(message, kVersionAt) != kPictureVersion) return std::nullopt;
  if (get<std::uint16_t>(message, kTypeAt) != kTypePicture) return std::nullopt;
  if (get<std::uint16_t>(message, kHeaderLengthAt) != kPictureHeaderBytes) return std::nullopt;
  const auto encoding = get<std::uint16_t>(message, kEncodingAt);
  if (encoding < 1 || encoding > 3) return std::nullopt;
  PictureHeader header;
  header.stream_id = get<std::uint32_t>(message, kStreamAt);
  header.sequence = get<std::uint32_t>(message, kSequenceAt);
  header.frame = get<std::int64_t>(message, kFrameAt);
  header.t_ns = get<std::int64_t>(message, kTimeAt);
  header.width_px = get<std::uint16_t>(message, kWidthAt);
  header.height_px = get<std::uint16_t>(message, kHeightAt);
  header.encoding = static_cast<PictureEncoding>(encoding);
  header.payload_bytes = get<std::uint32_t>(message, kPayloadLengthAt);
  const auto flags = get<std::uint32_t>(message, kFlagsAt);
  header.live = (flags & kFlagLive) != 0;
  header.key = (flags & kFlagKey) != 0;
  if ((flags & kFlagScale) != 0) {
    header.scale = {std::bit_cast<float>(get<std::uint32_t>(message, kScaleLowAt)),
                    std::bit_cast<float>(get<std::uint32_t>(message, kScaleHighAt)),
                    (flags & kFlagLogarithmic) != 0};
  }
  header.full_width_px = get<std::uint16_t>(message, kFullWidthAt);
  header.full_height_px = get<std::uint16_t>(message, kFullHeightAt);
  if (message.size() - kPictureHeaderBytes != header.payload_bytes) return std::nullopt;
  return header;
}

}  // namespace overfly::net
