// Finds MAVLink frames in bytes that may be damaged.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>

#include "flight/mavlink/frame.hpp"
#include "flight/mavlink/sequence_counter.hpp"

namespace overfly::flight::mavlink {

/// What was found and what was left out.
struct FrameCounts {
  std::uint64_t frames = 0;
  std::uint64_t bad_checksums = 0;  ///< frames left out because their checksum is wrong
  std::uint64_t skipped_bytes = 0;  ///< that belong to no valid frame
  /// Messages that are missing according to the sequence numbers, of all senders together.
  std::uint64_t lost_messages = 0;
};

/// Finds the frames in a stream of bytes, and finds the next one after damage.
///
/// A frame is accepted if its checksum is right. For a message that is not in the table CRC_EXTRA
/// is unknown: the checksum then only has to agree with that of the earlier messages of the same
/// id, and the first one is believed if it follows a valid frame directly.
class FrameFinder {
 public:
  /// @param prefix_bytes  bytes in front of every frame: 8 in a .tlog, 0 on a link
  explicit FrameFinder(std::size_t prefix_bytes = 0) : prefix_bytes_(prefix_bytes) {}

  struct Found {
    std::size_t consumed_bytes = 0;  ///< including skipped bytes, the prefix and the frame
    std::optional<Frame> frame;      ///< empty: more bytes are needed, or none are left
    std::span<const std::uint8_t> prefix;
    std::span<const std::uint8_t> bytes;  ///< of the frame, with its signature
  };
  /// The next frame in `bytes`, which begin where the previous call stopped consuming.
  /// @param last  no more bytes follow: an incomplete frame at the end is skipped
  /// Cost: linear in the consumed bytes; 280 times as much at worst, for bytes made so.
  [[nodiscard]] Found next(std::span<const std::uint8_t> bytes, bool last);

  [[nodiscard]] const FrameCounts& counts() const { return counts_; }

 private:
  struct Extra {
    std::uint8_t value = 0;
    bool confirmed = false;  ///< by a second message
  };

  [[nodiscard]] bool checksum_is_right(const FrameParts& parts);
  [[nodiscard]] bool agrees_with_others(const FrameParts& parts);
  void count_sequence(const Frame& frame);

  std::size_t prefix_bytes_ = 0;
  bool in_step_ = true;  ///< the last frame ended where the next one is expected
  FrameCounts counts_;
  std::unordered_map<std::uint32_t, Extra> extras_;  ///< of messages not in the table
  std::unordered_map<std::uint16_t, SequenceCounter> senders_;
};

}  // namespace overfly::flight::mavlink
