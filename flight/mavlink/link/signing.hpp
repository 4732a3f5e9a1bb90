// Signatures of MAVLink 2 frames.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/result.hpp"
#include "flight/mavlink/frame.hpp"

namespace overfly::flight::mavlink {

/// The secret that both ends of a link share.
using SigningKey = std::array<std::uint8_t, 32>;

/// Time of signatures: units of 10 us since 1 January 2015 UTC, 48 bits.
[[nodiscard]] std::uint64_t signing_time(std::chrono::system_clock::time_point utc);

/// The first 48 bits of SHA-256 over key, frame, link id and time stamp (MAVLink developer guide,
/// "Message Signing").
/// @param frame  from the start byte to the checksum
[[nodiscard]] std::array<std::uint8_t, 6> signature_of(const SigningKey& key,
                                                       std::span<const std::uint8_t> frame,
                                                       std::uint8_t link_id,
                                                       std::uint64_t timestamp);

/// The bytes of a frame with its signature. Errors: as encode_frame.
[[nodiscard]] Result<std::vector<std::uint8_t>> encode_signed_frame(const Frame& frame,
                                                                    const SigningKey& key,
                                                                    std::uint8_t link_id,
                                                                    std::uint64_t timestamp);

/// Reads a key: a file with 64 hexadecimal digits and nothing else but white space.
/// Errors: as read_file_text; kUnreadable naming the file. The content is never part of a message.
[[nodiscard]] Result<SigningKey> read_signing_key(const std::filesystem::path& file);

/// Checks signatures and that no frame is played back: time stamps of each sender and link id
/// increase, and a sender is only believed if its first one is at most one minute behind.
class SignatureCheck {
 public:
  /// @param timestamp  the present time of signatures
  SignatureCheck(const SigningKey& key, std::uint64_t timestamp)
      : key_(key), timestamp_(timestamp) {}

  /// @param bytes  of the frame, with its signature
  /// @return whether a frame is signed with the key and new
  [[nodiscard]] bool accepts(const Frame& frame, std::span<const std::uint8_t> bytes);
  /// The latest time that was seen or set: signatures of this program must not be older.
  [[nodiscard]] std::uint64_t timestamp() const { return timestamp_; }
  void advance(std::uint64_t timestamp);

 private:
  SigningKey key_;
  std::uint64_t timestamp_;
  std::map<std::uint32_t, std::uint64_t> latest_;  ///< by system, component and link id
};

}  // namespace overfly::flight::mavlink
