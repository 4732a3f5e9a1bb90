#include "core/measure/sha256.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>

namespace overfly {
namespace {

std::string digest_of(std::string_view text, std::size_t piece) {
  Sha256 hash;
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    hash.add(bytes.subspan(at, std::min(piece, bytes.size() - at)));
  }
  return hex_text(hash.finish());
}

TEST(Sha256, EqualsThePublishedExamples) {
  // Examples of FIPS 180-4 (NIST, "Cryptographic Standards: Examples with Intermediate Values").
  EXPECT_EQ(digest_of("", 1), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(digest_of("abc", 3),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  const std::string_view two_blocks = "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq";
  for (const std::size_t piece : {1U, 7U, 56U}) {
    EXPECT_EQ(digest_of(two_blocks, piece),
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  }
}

}  // namespace
}  // namespace overfly
