// Takes the fields of a serialised ROS message one after the other.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

namespace overfly::flight::logs {

static_assert(std::endian::native == std::endian::little, "numbers are copied or reversed");

/// How ROS messages are laid out.
enum class RosEncoding {
  kRos1,  ///< little-endian, without padding, text without a terminator
  kCdr,   ///< plain CDR of ROS 2 (OMG DDS-XTypes 1.3, 7.4.1): a header of 4 bytes states the byte
          ///< order, numbers are aligned to their size, text ends with a zero
  kOther,
};

/// A place in a message. Reading beyond the end gives zeros and ok() is false from then on.
class RosCursor {
 public:
  /// @param bytes  of ROS 1: the message; of CDR: what follows the header of 4 bytes
  RosCursor(std::span<const std::uint8_t> bytes, RosEncoding encoding, bool big_endian)
      : bytes_(bytes), encoding_(encoding), big_endian_(big_endian) {}

  template <typename T>
  requires std::integral<T> || std::floating_point<T>
  [[nodiscard]] T number() {
    if (encoding_ == RosEncoding::kCdr) at_ = (at_ + sizeof(T) - 1) / sizeof(T) * sizeof(T);
    std::uint8_t raw[sizeof(T)] = {};
    if (take(sizeof(T))) {
      const std::uint8_t* const from = bytes_.data() + at_ - sizeof(T);
      for (std::size_t i = 0; i < sizeof(T); ++i) {
        raw[i] = from[big_endian_ ? sizeof(T) - 1 - i : i];
      }
    }
    T value{};
    std::memcpy(&value, raw, sizeof value);
    return value;
  }

  [[nodiscard]] std::string_view text() {
    const auto length = number<std::uint32_t>();
    if (!take(length)) return {};
    const char* const from = reinterpret_cast<const char*>(bytes_.data() + at_ - length);
    const bool terminated = encoding_ == RosEncoding::kCdr && length > 0;
    return {from, terminated ? length - 1 : length};
  }

  /// A sequence of bytes with its length in front; empty if they end early.
  [[nodiscard]] std::span<const std::uint8_t> octets() {
    const auto length = number<std::uint32_t>();
    if (!take(length)) return {};
    return bytes_.subspan(at_ - length, length);
  }

  [[nodiscard]] RosEncoding encoding() const { return encoding_; }
  [[nodiscard]] bool ok() const { return ok_; }

 private:
  [[nodiscard]] bool take(std::size_t count) {
    ok_ = ok_ && at_ <= bytes_.size() && count <= bytes_.size() - at_;
    if (ok_) at_ += count;
    return ok_;
  }

  std::span<const std::uint8_t> bytes_;
  RosEncoding encoding_;
  bool big_endian_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

}  // namespace overfly::flight::logs
