#include "core/measure/crc32.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace overfly {

namespace {

/// Table k: effect of a byte on the remainder k bytes later (Sarwate 1988, DOI 10.1145/63030.63037,
/// eight bytes at a time).
using CrcTables = std::array<std::array<std::uint32_t, 256>, 8>;

constexpr CrcTables crc_tables() {
  CrcTables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t rest = byte;
    for (int bit = 0; bit < 8; ++bit) rest = (rest >> 1U) ^ ((rest & 1U) != 0 ? 0xEDB88320U : 0U);
    tables[0][byte] = rest;
  }
  for (std::size_t k = 1; k < tables.size(); ++k) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t before = tables[k - 1][byte];
      tables[k][byte] = (before >> 8U) ^ tables[0][before & 255U];
    }
  }
  return tables;
}

}  // namespace

std::uint32_t crc32_of(const Image& image) {
  static constexpr CrcTables kTables = crc_tables();
  const std::vector<std::uint8_t>& bytes = image.data;
  std::uint32_t rest = 0xFFFFFFFFU;
  std::size_t i = 0;
  for (; i + 8 <= bytes.size(); i += 8) {
    std::uint32_t next = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      next ^= kTables[7 - k][(bytes[i + k] ^ (rest >> (8U * k))) & 255U];
      next ^= kTables[3 - k][bytes[i + 4 + k]];
    }
    rest = next;
  }
  for (; i < bytes.size(); ++i) {
    rest = (rest >> 8U) ^ kTables[0][(rest ^ bytes[i]) & 255U];
  }
  return ~rest;
}

}  // namespace overfly
