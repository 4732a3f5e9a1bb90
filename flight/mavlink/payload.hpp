// Numbers and text in the payload of a MAVLink message.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>

namespace overfly::flight::mavlink {

static_assert(std::endian::native == std::endian::little, "payloads are little-endian");

/// Reads a payload at the offsets of its definition. Bytes that were not sent are zero: MAVLink 2
/// leaves out zeros at the end, and MAVLink 1 has no extension fields.
class PayloadReader {
 public:
  explicit PayloadReader(std::span<const std::uint8_t> payload) : payload_(payload) {}

  template <typename T>
  [[nodiscard]] T at(std::size_t offset) const {
    static_assert(std::is_arithmetic_v<T>);
    std::array<std::uint8_t, sizeof(T)> bytes{};
    if (offset < payload_.size()) {
      std::memcpy(
          bytes.data(), payload_.data() + offset, std::min(sizeof(T), payload_.size() - offset));
    }
    return std::bit_cast<T>(bytes);
  }

  /// Text of at most `length` bytes that ends before its first zero. Bytes that are not printable
  /// ASCII become '?'.
  [[nodiscard]] std::string text(std::size_t offset, std::size_t length) const;

 private:
  std::span<const std::uint8_t> payload_;
};

}  // namespace overfly::flight::mavlink
