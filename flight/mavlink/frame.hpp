// One MAVLink frame as bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/result.hpp"

namespace overfly::flight::mavlink {

enum class Version : std::uint8_t { kOne = 1, kTwo = 2 };

/// Start bytes of the two versions.
inline constexpr std::uint8_t kStartOne = 0xFE;
inline constexpr std::uint8_t kStartTwo = 0xFD;
/// Bytes of the longest frame: header 10, payload 255, checksum 2, signature 13.
inline constexpr std::size_t kMaxFrameBytes = 280;
inline constexpr std::size_t kSignatureBytes = 13;

struct Frame {
  Version version = Version::kTwo;
  std::uint8_t sequence = 0;
  std::uint8_t system = 0;
  std::uint8_t component = 0;
  std::uint32_t message_id = 0;
  bool is_signed = false;  ///< a signature follows the checksum; see link/signing.hpp
  /// As sent: MAVLink 2 leaves out zeros at the end. Points into the bytes that were parsed.
  std::span<const std::uint8_t> payload;
};

/// The header of a frame, its length and its checksum, before the checksum is compared.
struct FrameParts {
  Frame frame;
  std::size_t size_bytes = 0;  ///< with checksum and signature
  /// Over everything that the checksum covers except CRC_EXTRA.
  std::uint16_t checksum_without_extra = 0;
  std::uint16_t checksum_received = 0;
};

enum class FrameState {
  kComplete,    ///< the parts are there; the checksum is still to be compared
  kIncomplete,  ///< the bytes end within the frame
  kNoFrame,     ///< no start byte, or flags that this version of MAVLink does not define
};

/// Takes apart the frame at the start of `bytes`.
[[nodiscard]] FrameState take_apart(std::span<const std::uint8_t> bytes, FrameParts& parts);

/// The bytes of a frame, without the signature of a signed one. Zeros at the end of the payload are
/// left out in version 2.
/// Errors: kInvalidArgument if the message is not in the table, its id or a signature does not fit
/// into the version, or the payload is longer than the message.
[[nodiscard]] Result<std::vector<std::uint8_t>> encode_frame(const Frame& frame);

}  // namespace overfly::flight::mavlink
