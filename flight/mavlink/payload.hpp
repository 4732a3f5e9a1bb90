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
#include <string_view>
#include <type_traits>
#include <vector>

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

/// Builds a payload at the offsets of its definition; all other bytes are zero.
class PayloadWriter {
 public:
  /// @param size  of the payload with its extension fields
  explicit PayloadWriter(std::size_t size) : bytes_(size) {}

  /// @pre the value lies within the payload
  template <typename T>
  PayloadWriter& put(std::size_t offset, T value) {
    static_assert(std::is_arithmetic_v<T>);
    std::memcpy(bytes_.data() + offset, &value, sizeof value);
    return *this;
  }
  /// Text that ends after `length` bytes, or before at its first zero.
  PayloadWriter& put_text(std::size_t offset, std::string_view text, std::size_t length) {
    std::memcpy(bytes_.data() + offset, text.data(), std::min(text.size(), length));
    return *this;
  }
  [[nodiscard]] const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace overfly::flight::mavlink
