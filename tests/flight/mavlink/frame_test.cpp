#include "flight/mavlink/frame.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "flight/mavlink/checksum.hpp"
#include "flight/mavlink/frame_finder.hpp"
#include "flight/mavlink/message_table.hpp"
#include "tests/flight/logs/log_bytes.hpp"

namespace overfly::flight::mavlink {
namespace {

using testing::append;
using testing::attitude_payload;
using testing::Bytes;
using testing::frame_bytes;
using ::testing::HasSubstr;

constexpr std::uint32_t kAttitudeId = 30;

Bytes bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

/// All frames that a finder accepts when it gets `bytes` in pieces.
std::vector<Frame> frames_in(FrameFinder& finder, const Bytes& bytes) {
  std::vector<Frame> frames;
  std::span<const std::uint8_t> rest = bytes;
  while (true) {
    const FrameFinder::Found found = finder.next(rest, true);
    rest = rest.subspan(found.consumed_bytes);
    if (!found.frame) return frames;
    frames.push_back(*found.frame);
  }
}

TEST(MavlinkChecksum, MatchesThePublishedCheckValue) {
  // CRC-16/MCRF4XX in the catalogue of parametrised CRC algorithms: check = 0x6f91.
  EXPECT_EQ(add_to_checksum(kChecksumStart, bytes_of("123456789")), 0x6F91);
}

TEST(MavlinkChecksum, IsTheSameInPiecesOfAnyLength) {
  Bytes bytes;
  for (int i = 0; i < 100; ++i) bytes.push_back(static_cast<std::uint8_t>(i * 37));
  const std::span<const std::uint8_t> all = bytes;
  const std::uint16_t whole = add_to_checksum(kChecksumStart, all);
  for (std::size_t cut = 0; cut <= bytes.size(); ++cut) {
    const std::uint16_t first = add_to_checksum(kChecksumStart, all.first(cut));
    EXPECT_EQ(add_to_checksum(first, all.subspan(cut)), whole) << cut;
  }
}

TEST(MavlinkChecksum, FindsTheByteBetweenTwoChecksums) {
  for (int byte = 0; byte < 256; ++byte) {
    const auto wanted = static_cast<std::uint8_t>(byte);
    EXPECT_EQ(byte_between(0x1234, add_to_checksum(std::uint16_t{0x1234}, wanted)), wanted);
  }
}

TEST(MavlinkTable, HasTheExtraByteThatTheDefinitionGives) {
  // CRC_EXTRA of a message: the checksum of its name and of its base fields in wire order, as
  // "type name ", folded to one byte (MAVLink developer guide, "CRC_EXTRA Calculation").
  const auto extra_of = [](std::string_view definition) {
    const std::uint16_t sum = add_to_checksum(kChecksumStart, bytes_of(definition));
    return static_cast<std::uint8_t>((sum & 0xFFU) ^ (sum >> 8U));
  };
  EXPECT_EQ(message_facts(30)->checksum_extra,
            extra_of("ATTITUDE uint32_t time_boot_ms float roll float pitch float yaw "
                     "float rollspeed float pitchspeed float yawspeed "));
  EXPECT_EQ(message_facts(295)->checksum_extra,
            extra_of("AIRSPEED float airspeed float raw_press int16_t temperature uint8_t id "
                     "uint8_t flags "));
  EXPECT_EQ(message_facts(11020)->checksum_extra,
            extra_of("AOA_SSA uint64_t time_usec float AOA float SSA "));
  EXPECT_EQ(message_facts(0)->checksum_extra,
            extra_of("HEARTBEAT uint32_t custom_mode uint8_t type uint8_t autopilot "
                     "uint8_t base_mode uint8_t system_status uint8_t mavlink_version "));
  EXPECT_EQ(message_facts(7), nullptr);
  EXPECT_EQ(message_facts(0xFFFFFF), nullptr);
}

TEST(MavlinkFrame, RoundTripsInBothVersions) {
  const Bytes payload = attitude_payload(123456, 0.1F, -0.2F, 3.0F);
  for (const Version version : {Version::kOne, Version::kTwo}) {
    const Bytes bytes = frame_bytes(kAttitudeId, payload, 77, 5, version);
    FrameFinder finder;
    const std::vector<Frame> frames = frames_in(finder, bytes);
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(frames[0].version, version);
    EXPECT_EQ(frames[0].sequence, 77);
    EXPECT_EQ(frames[0].system, 5);
    EXPECT_EQ(frames[0].component, 1);
    EXPECT_EQ(frames[0].message_id, kAttitudeId);
    EXPECT_EQ(Bytes(frames[0].payload.begin(), frames[0].payload.end()), payload);
    EXPECT_EQ(finder.counts().skipped_bytes, 0U);
  }
}

TEST(MavlinkFrame, LeavesOutZerosAtTheEndInVersionTwoOnly) {
  const Bytes zeros(9, 0);
  EXPECT_EQ(frame_bytes(0, zeros, 0, 1, Version::kOne).size(), 6U + 9U + 2U);
  EXPECT_EQ(frame_bytes(0, zeros, 0, 1, Version::kTwo).size(), 10U + 1U + 2U);
}

TEST(MavlinkFrame, RejectsWhatItCannotEncode) {
  EXPECT_THAT(encode_frame({Version::kTwo, 0, 1, 1, 7, false, {}}).error().message,
              HasSubstr("message 7: is not in the table"));
  EXPECT_THAT(encode_frame({Version::kOne, 0, 1, 1, 11020, false, {}}).error().message,
              HasSubstr("needs MAVLink 2"));
  const Bytes long_payload(10, 1);
  EXPECT_THAT(encode_frame({Version::kTwo, 0, 1, 1, 0, false, long_payload}).error().message,
              HasSubstr("10 bytes: must have at most 9"));
}

TEST(FrameFinder, SkipsTheSignature) {
  Bytes bytes = frame_bytes(kAttitudeId, attitude_payload(1, 1, 1, 1), 0);
  bytes[2] = 1;  // signed: this flag is part of the checksum
  const auto size = static_cast<std::size_t>(bytes[1]) + 10;
  const std::uint16_t sum = add_to_checksum(
      add_to_checksum(kChecksumStart, std::span(bytes).subspan(1, size - 1)), std::uint8_t{39});
  bytes[size] = static_cast<std::uint8_t>(sum & 0xFFU);
  bytes[size + 1] = static_cast<std::uint8_t>(sum >> 8U);
  bytes.resize(bytes.size() + 13, 0xFD);
  append(bytes, frame_bytes(kAttitudeId, attitude_payload(2, 1, 1, 1), 1));
  FrameFinder finder;
  const std::vector<Frame> frames = frames_in(finder, bytes);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_TRUE(frames[0].is_signed);
  EXPECT_FALSE(frames[1].is_signed);
  EXPECT_EQ(finder.counts().skipped_bytes, 0U);
}

TEST(FrameFinder, CountsDamageAndLosses) {
  Bytes bytes;
  for (const std::uint8_t sequence : {250, 251, 252, 253, 1, 2}) {
    Bytes frame = frame_bytes(kAttitudeId, attitude_payload(sequence, 1, 1, 1), sequence);
    if (sequence == 252) frame[20] ^= 0xFF;
    append(bytes, frame);
    if (sequence == 1) append(bytes, {0x00, 0xFE, 0xFD, 0x03});
  }
  FrameFinder finder;
  EXPECT_EQ(frames_in(finder, bytes).size(), 5U);
  EXPECT_EQ(finder.counts().frames, 5U);
  EXPECT_EQ(finder.counts().bad_checksums, 1U);
  EXPECT_EQ(finder.counts().lost_messages, 1U + 3U);  // 252, and 254, 255, 0
  EXPECT_EQ(finder.counts().skipped_bytes,
            frame_bytes(kAttitudeId, attitude_payload(252, 1, 1, 1), 252).size() + 4U);
}

TEST(FrameFinder, FindsTheSameFramesInPiecesOfAnySize) {
  Bytes bytes;
  for (std::uint8_t i = 0; i < 20; ++i) {
    Bytes frame = frame_bytes(kAttitudeId, attitude_payload(i, 1, 1, 1), i);
    if (i % 5 == 2) frame[15] ^= 0x55;
    append(bytes, frame);
    if (i % 7 == 3) append(bytes, {0xFD, 0x20, 0x00, 0x99});
  }
  FrameFinder whole;
  EXPECT_EQ(frames_in(whole, bytes).size(), 16U);
  for (const std::size_t piece : {1U, 7U, 40U, 300U}) {
    FrameFinder finder;
    Bytes held;
    for (std::size_t at = 0; at < bytes.size(); at += piece) {
      const std::size_t end = std::min(at + piece, bytes.size());
      held.insert(held.end(),
                  bytes.begin() + static_cast<std::ptrdiff_t>(at),
                  bytes.begin() + static_cast<std::ptrdiff_t>(end));
      while (true) {
        const FrameFinder::Found found = finder.next(held, end == bytes.size());
        held.erase(held.begin(), held.begin() + static_cast<std::ptrdiff_t>(found.consumed_bytes));
        if (!found.frame) break;
      }
    }
    EXPECT_EQ(finder.counts().frames, 16U) << piece;
    EXPECT_EQ(finder.counts().bad_checksums, whole.counts().bad_checksums) << piece;
    EXPECT_EQ(finder.counts().skipped_bytes, whole.counts().skipped_bytes) << piece;
  }
}

TEST(FrameFinder, AcceptsUnlistedMessagesThatAgreeWithEachOther) {
  // Id 12345 is not in the table; its sender uses the extra byte 99.
  const auto unlisted = [](std::uint8_t sequence, std::uint8_t extra) {
    Bytes bytes = {0xFD, 4, 0, 0, sequence, 1, 1, 0x39, 0x30, 0, 1, 2, 3, sequence};
    const std::uint16_t sum =
        add_to_checksum(add_to_checksum(kChecksumStart, std::span(bytes).subspan(1)), extra);
    bytes.push_back(static_cast<std::uint8_t>(sum & 0xFFU));
    bytes.push_back(static_cast<std::uint8_t>(sum >> 8U));
    return bytes;
  };
  Bytes bytes;
  append(bytes, unlisted(0, 99));
  append(bytes, unlisted(1, 99));
  append(bytes, unlisted(2, 98));
  append(bytes, unlisted(3, 99));
  FrameFinder finder;
  EXPECT_EQ(frames_in(finder, bytes).size(), 3U);
  EXPECT_EQ(finder.counts().bad_checksums, 1U);
}

}  // namespace
}  // namespace overfly::flight::mavlink
