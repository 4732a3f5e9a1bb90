// Checksum of MAVLink frames.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace overfly::flight::mavlink {

inline constexpr std::uint16_t kChecksumStart = 0xFFFF;

/// CRC-16/MCRF4XX: polynomial 0x1021 reflected, start value 0xFFFF, no final inversion. Continues
/// `checksum` over more bytes. Check value of "123456789": 0x6F91.
[[nodiscard]] std::uint16_t add_to_checksum(std::uint16_t checksum,
                                            std::span<const std::uint8_t> bytes);
[[nodiscard]] std::uint16_t add_to_checksum(std::uint16_t checksum, std::uint8_t byte);

/// The byte that leads from one checksum to another, if there is one. Of all pairs of checksums one
/// in 256 has one.
[[nodiscard]] std::optional<std::uint8_t> byte_between(std::uint16_t before, std::uint16_t after);

}  // namespace overfly::flight::mavlink
