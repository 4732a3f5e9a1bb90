// The MAVLink messages whose checksum is known.
#pragma once

#include <cstdint>

namespace overfly::flight::mavlink {

/// What the frame of a message depends on.
struct MessageFacts {
  std::uint32_t id = 0;
  const char* name = "";
  /// CRC_EXTRA: derived from the names and types of the base fields, added to the checksum after
  /// the payload, so that a peer with another definition of the message is noticed.
  std::uint8_t checksum_extra = 0;
  std::uint16_t base_bytes = 0;  ///< payload without extension fields: the length in MAVLink 1
  std::uint16_t full_bytes = 0;  ///< payload with extension fields
};

/// The facts of a message; null if its id is not in the table.
[[nodiscard]] const MessageFacts* message_facts(std::uint32_t id);

}  // namespace overfly::flight::mavlink
