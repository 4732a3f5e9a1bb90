// The checksum of eight bytes at a time: "slicing-by-8" (Kounavis and Berry, 2008,
// doi:10.1109/TC.2008.85), applied to a 16-bit CRC.
#include "flight/mavlink/checksum.hpp"

#include <array>
#include <cstddef>

namespace overfly::flight::mavlink {
namespace {

using ChecksumTable = std::array<std::uint16_t, 256>;

/// tables[k][b] is the effect of byte b after k further zero bytes.
constexpr std::array<ChecksumTable, 8> checksum_tables() {
  std::array<ChecksumTable, 8> tables{};
  for (unsigned byte = 0; byte < 256; ++byte) {
    unsigned value = byte;
    for (int bit = 0; bit < 8; ++bit) value = (value >> 1U) ^ ((value & 1U) != 0 ? 0x8408U : 0U);
    tables[0][byte] = static_cast<std::uint16_t>(value);
  }
  for (std::size_t k = 1; k < tables.size(); ++k) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const unsigned before = tables[k - 1][byte];
      tables[k][byte] = static_cast<std::uint16_t>((before >> 8U) ^ tables[0][before & 0xFFU]);
    }
  }
  return tables;
}

constexpr std::array<ChecksumTable, 8> kTables = checksum_tables();

}  // namespace

std::uint16_t add_to_checksum(std::uint16_t checksum, std::uint8_t byte) {
  return static_cast<std::uint16_t>((checksum >> 8U) ^ kTables[0][(checksum ^ byte) & 0xFFU]);
}

std::uint16_t add_to_checksum(std::uint16_t checksum, std::span<const std::uint8_t> bytes) {
  while (bytes.size() >= 8) {
    const std::uint8_t* const b = bytes.data();
    checksum = static_cast<std::uint16_t>(kTables[7][(b[0] ^ checksum) & 0xFFU] ^
                                          kTables[6][(b[1] ^ (checksum >> 8U)) & 0xFFU] ^
                                          kTables[5][b[2]] ^ kTables[4][b[3]] ^ kTables[3][b[4]] ^
                                          kTables[2][b[5]] ^ kTables[1][b[6]] ^ kTables[0][b[7]]);
    bytes = bytes.subspan(8);
  }
  for (const std::uint8_t byte : bytes) checksum = add_to_checksum(checksum, byte);
  return checksum;
}

std::optional<std::uint8_t> byte_between(std::uint16_t before, std::uint16_t after) {
  const unsigned entry = (before >> 8U) ^ after;
  for (unsigned i = 0; i < 256; ++i) {
    if (kTables[0][i] == entry) return static_cast<std::uint8_t>((i ^ before) & 0xFFU);
  }
  return std::nullopt;
}

}  // namespace overfly::flight::mavlink
