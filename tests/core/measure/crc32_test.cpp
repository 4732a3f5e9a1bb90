#include "core/measure/crc32.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

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
