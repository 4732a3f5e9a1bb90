// The messages of a ULog file as bytes. Private to ulog.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace overfly::flight::logs {

static_assert(std::endian::native == std::endian::little, "ULog is little-endian");

/// Length (uint16_t) and kind of a message.
inline constexpr std::size_t kUlogMessageHeaderBytes = 3;

/// A number at an offset; 0 if the bytes end before it.
template <typename T>
[[nodiscard]] T ulog_value(std::span<const std::uint8_t> bytes, std::size_t offset) {
  T value{};
  if (offset + sizeof(T) <= bytes.size()) std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

/// What lies at a place of the file.
struct UlogPlace {
  enum class Kind { kMessage, kUnknownKind, kCut, kDamage } kind = Kind::kDamage;
  std::size_t size = 0;  ///< [bytes] with the header
};

/// Looks at the start of `bytes`. A message is believed if one of a known kind, or the limit,
/// follows.
/// @param limit    bytes up to the end of the file or the next appended data
/// @param in_step  a message ended here: one that reaches beyond the limit is then believed to be
/// cut
[[nodiscard]] UlogPlace look_at_message(std::span<const std::uint8_t> bytes,
                                        std::uint64_t limit,
                                        bool in_step);

}  // namespace overfly::flight::logs
