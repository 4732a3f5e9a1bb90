#include "flight/mavlink/link/signing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/measure/sha256.hpp"
#include "flight/mavlink/frame_finder.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight::mavlink {
namespace {

using ::testing::HasSubstr;

SigningKey counting_key() {
  SigningKey key{};
  for (std::size_t i = 0; i < key.size(); ++i) key[i] = static_cast<std::uint8_t>(i);
  return key;
}

constexpr std::array<std::uint8_t, 9> kHeartbeat = {10, 0, 0, 0, 1, 3, 0x81, 4, 3};
const Frame kFrame{Version::kTwo, 7, 1, 1, 0, false, kHeartbeat};

/// Whether a check accepts the one frame in `bytes`.
bool accepted(SignatureCheck& check, const std::vector<std::uint8_t>& bytes) {
  FrameFinder finder;
  const FrameFinder::Found found = finder.next(bytes, true);
  return found.frame && check.accepts(*found.frame, found.bytes);
}

std::vector<std::uint8_t> signed_at(std::uint64_t timestamp, std::uint8_t link_id = 3) {
  return *encode_signed_frame(kFrame, counting_key(), link_id, timestamp);
}

TEST(Signing, EqualsAnIndependentImplementation) {
  // Computed with Python's hashlib and a bitwise CRC: a heartbeat, link id 3, time 0x0102030405.
  EXPECT_EQ(hex_text(signed_at(0x0102030405)),
            "fd0901000701010000000a00000001038104032191"
            "03"
            "050403020100"
            "0c9281efb0bf");
}

TEST(Signing, CountsTensOfMicrosecondsSinceTheYear2015) {
  using std::chrono::system_clock;
  EXPECT_EQ(signing_time(system_clock::from_time_t(1'420'070'400)), 0U);
  EXPECT_EQ(signing_time(system_clock::from_time_t(1'420'070'401)), 100'000U);
  EXPECT_EQ(signing_time(system_clock::from_time_t(0)), 0U);
}

TEST(SignatureCheck, AcceptsEveryFrameOnce) {
  SignatureCheck check(counting_key(), 1'000'000);
  EXPECT_TRUE(accepted(check, signed_at(1'000'000)));
  EXPECT_FALSE(accepted(check, signed_at(1'000'000)));
  EXPECT_FALSE(accepted(check, signed_at(999'999)));
  EXPECT_TRUE(accepted(check, signed_at(1'000'001)));
  EXPECT_TRUE(accepted(check, signed_at(1'000'001, 4)));  // another link counts by itself
}

TEST(SignatureCheck, RefusesForgeriesAndOldRecordings) {
  SignatureCheck check(counting_key(), 10'000'000);
  EXPECT_FALSE(accepted(check, *encode_frame(kFrame)));
  SigningKey other = counting_key();
  other[31] ^= 1U;
  EXPECT_FALSE(accepted(check, *encode_signed_frame(kFrame, other, 3, 10'000'000)));
  std::vector<std::uint8_t> forged = signed_at(10'000'000);
  forged.back() ^= 1U;
  EXPECT_FALSE(accepted(check, forged));
  EXPECT_FALSE(accepted(check, signed_at(10'000'000 - 6'000'001)));  // more than one minute old
  EXPECT_TRUE(accepted(check, signed_at(10'000'000 - 6'000'000)));
}

TEST(SigningKey, IsReadFromHexadecimalDigits) {
  overfly::testing::TemporaryFolder folder;
  const auto file = folder.path() / "key";
  overfly::testing::write_text(file, hex_text(counting_key()) + "\n");
  const Result<SigningKey> key = read_signing_key(file);
  ASSERT_TRUE(key.ok()) << key.error().message;
  EXPECT_EQ(*key, counting_key());
  for (const std::string& text :
       {std::string(63, 'a'), std::string(65, 'a'), std::string("secret")}) {
    overfly::testing::write_text(file, text);
    const Result<SigningKey> bad = read_signing_key(file);
    ASSERT_FALSE(bad.ok());
    EXPECT_THAT(bad.error().message, HasSubstr("64 hexadecimal digits"));
    EXPECT_THAT(bad.error().message, ::testing::Not(HasSubstr("secret")));
  }
}

}  // namespace
}  // namespace overfly::flight::mavlink
