#include "core/measure/crc32.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

namespace overfly {
namespace {

Image image_of(const std::string& bytes) {
  Image image(static_cast<int>(bytes.size()), 1, 1);
  std::copy(bytes.begin(), bytes.end(), image.data.begin());
  return image;
}

TEST(Crc32, IsThatOfZlibAndPng) {
  // The check value of CRC-32/ISO-HDLC, and values of Python's zlib.crc32.
  EXPECT_EQ(crc32_of(image_of("123456789")), 0xCBF43926U);
  EXPECT_EQ(crc32_of(image_of("The quick brown fox jumps over the lazy dog")), 0x414FA339U);
  EXPECT_EQ(crc32_of(image_of("a")), 0xE8B7BE43U);
}

/// Bit by bit, from the definition (ISO 3309).
std::uint32_t plain_crc32(const std::vector<std::uint8_t>& bytes) {
  std::uint32_t rest = 0xFFFFFFFFU;
  for (const std::uint8_t byte : bytes) {
    rest ^= byte;
    for (int bit = 0; bit < 8; ++bit) rest = (rest >> 1U) ^ ((rest & 1U) * 0xEDB88320U);
  }
  return ~rest;
}

TEST(Crc32, IsThatOfTheDefinitionForImagesOfEveryLength) {
  std::mt19937 random(3);
  std::vector<int> widths = {4099, 65537};
  for (int width = 1; width <= 300; ++width) widths.push_back(width);
  for (const int width : widths) {
    Image image(width, 1, 1);
    for (std::uint8_t& byte : image.data) byte = static_cast<std::uint8_t>(random());
    EXPECT_EQ(crc32_of(image), plain_crc32(image.data)) << width << " bytes";
  }
}

TEST(Crc32, ChangesWithEveryBit) {
  Image image(13, 3, 1, 7);
  const std::uint32_t before = crc32_of(image);
  for (std::uint8_t& byte : image.data) {
    byte ^= 16U;
    EXPECT_NE(crc32_of(image), before);
    byte ^= 16U;
  }
}

}  // namespace
}  // namespace overfly
