#include "flight/mavlink/link/frame_link.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <deque>
#include <string>

#include "flight/mavlink/link/open_byte_link.hpp"
#include "tests/flight/logs/log_bytes.hpp"
#include "tests/flight/mavlink/link/peer_socket.hpp"
#include "tests/flight/mavlink/link/test_link.hpp"

namespace overfly::flight::mavlink {
namespace {

using testing::append;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::PeerSocket;

TEST(FrameLink, CountsLossesOfEachSenderExactly) {
  TestLink link("udp-listen:127.0.0.1:0");
  PeerSocket peer(SOCK_DGRAM);
  ASSERT_TRUE(peer.connect_to(link.port()));
  std::size_t sent = 0;
  for (int i = 0; i < 300; ++i) {
    const auto sequence = static_cast<std::uint8_t>(i);
    if (i % 10 != 3) sent += peer.send(attitude_frame(sequence)) ? 1 : 0;     // 30 losses
    if (i % 50 != 7) sent += peer.send(attitude_frame(sequence, 9)) ? 1 : 0;  // 6 losses
    if (i == 100) sent += peer.send(attitude_frame(sequence, 9)) ? 1 : 0;     // twice
    ASSERT_TRUE(link.step_until_frames(sent));
  }
  const auto& senders = link.link->senders();
  ASSERT_EQ(senders.size(), 2U);
  EXPECT_EQ(senders.at(0x0101).sequence.lost(), 30U);
  EXPECT_EQ(senders.at(0x0101).frames, 270U);
  EXPECT_EQ(senders.at(0x0901).sequence.lost(), 6U);
  EXPECT_EQ(senders.at(0x0901).sequence.duplicates(), 1U);
}

TEST(FrameLink, KeepsFramesOfSeveralPeersApart) {
  TestLink link("udp-listen:127.0.0.1:0");
  PeerSocket a(SOCK_DGRAM);
  PeerSocket b(SOCK_DGRAM);
  ASSERT_TRUE(a.connect_to(link.port()) && b.connect_to(link.port()));
  const Bytes first = attitude_frame(1, 1);
  const Bytes second = attitude_frame(2, 2);
  // Bridges from serial lines cut frames anywhere.
  const std::span<const std::uint8_t> first_bytes = first;
  const std::span<const std::uint8_t> second_bytes = second;
  ASSERT_TRUE(a.send(first_bytes.first(20)));
  ASSERT_TRUE(link.step_until([&] { return link.link->counts().received_bytes == 20; }));
  ASSERT_TRUE(b.send(second_bytes.first(11)));
  ASSERT_TRUE(link.step_until([&] { return link.link->counts().received_bytes == 31; }));
  ASSERT_TRUE(a.send(first_bytes.subspan(20)));
  ASSERT_TRUE(link.step_until_frames(1));
  ASSERT_TRUE(b.send(second_bytes.subspan(11)));
  ASSERT_TRUE(link.step_until_frames(2));
  EXPECT_THAT(link.frames, ElementsAre("1:1", "2:2"));
  EXPECT_EQ(link.link->counts().skipped_bytes, 0U);

  // To one system by its own way only; to all that were heard.
  ASSERT_TRUE(link.link->send(kHeartbeatId, kBeat, 2).ok());
  EXPECT_THAT(sent_frames_in(b.receive()), ElementsAre("255:0"));
  EXPECT_FALSE(a.readable(0));
  ASSERT_TRUE(link.link->send(kHeartbeatId, kBeat, 0).ok());
  EXPECT_THAT(sent_frames_in(a.receive()), ElementsAre("255:0"));
  EXPECT_THAT(sent_frames_in(b.receive()), ElementsAre("255:0"));
}

/// A link holds 16 peers.
TEST(FrameLink, ForgetsAPeerWhoseNumberAnotherOneGets) {
  TestLink link("udp-listen:127.0.0.1:0");
  std::deque<PeerSocket> peers;
  const auto speak = [&](std::uint8_t system) {
    peers.emplace_back(SOCK_DGRAM);
    EXPECT_TRUE(peers.back().connect_to(link.port()));
    EXPECT_TRUE(peers.back().send(attitude_frame(0, system)));
    EXPECT_TRUE(link.step_until_frames(peers.size()));
  };
  speak(1);
  const Bytes half = attitude_frame(1);
  ASSERT_TRUE(peers[0].send(std::span(half).first(20)));
  for (std::uint8_t system = 2; system <= 17; ++system) speak(system);
  EXPECT_EQ(link.frames.back(), "17:0");
  EXPECT_EQ(link.link->counts().bad_checksums, 0U);
  EXPECT_EQ(link.link->counts().skipped_bytes, 20U);
  // The way to system 1 is not known any more: not that of system 17.
  ASSERT_TRUE(link.link->send(kHeartbeatId, kBeat, 1).ok());
  EXPECT_THAT(sent_frames_in(peers[1].receive()), ElementsAre("255:0"));
  EXPECT_THAT(sent_frames_in(peers[16].receive()), ElementsAre("255:0"));
  EXPECT_FALSE(peers[0].readable(0));
  ASSERT_TRUE(link.link->send(kHeartbeatId, kBeat, 2).ok());
  EXPECT_THAT(sent_frames_in(peers[1].receive()), ElementsAre("255:0"));
  EXPECT_FALSE(peers[16].readable(0));
}

TEST(FrameLink, SurvivesGarbageAndGetsBackInStep) {
  TestLink link("udp-listen:127.0.0.1:0");
  PeerSocket peer(SOCK_DGRAM);
  ASSERT_TRUE(peer.connect_to(link.port()));
  Bytes garbage;
  std::uint32_t state = 1;
  for (int i = 0; i < 1000; ++i) {
    state = state * 1664525U + 1013904223U;
    garbage.push_back(static_cast<std::uint8_t>(state >> 24U));
  }
  append(garbage, {0xFD, 0xFF, 0x00});  // the start of a long frame that never comes
  ASSERT_TRUE(peer.send(garbage));
  Bytes frames;
  for (std::uint8_t i = 0; i < 10; ++i) append(frames, attitude_frame(i));
  ASSERT_TRUE(peer.send(frames));
  EXPECT_TRUE(link.step_until_frames(10));
  EXPECT_EQ(link.link->counts().skipped_bytes, garbage.size());
  EXPECT_EQ(link.link->counts().received_frames, 10U);
}

TEST(FrameLink, ReadOnlyLinksNeverSend) {
  LinkOptions options;
  options.read_only = true;
  // The gate itself: below everything that sends.
  PeerSocket listener(SOCK_STREAM);
  const std::uint16_t port = listener.bind_to(0, true);
  const LinkAddress address = *parse_link_address("tcp:127.0.0.1:" + std::to_string(port), "link");
  auto bytes = open_byte_link(address, true);
  ASSERT_TRUE(bytes.ok());
  PeerSocket other_end = listener.accept();
  for (int i = 0; i < 500 && !(*bytes)->connected(); ++i) {
    ASSERT_TRUE((*bytes)
                    ->exchange(
                        {}, [](PeerId, std::span<const std::uint8_t>) {}, [](PeerId) {})
                    .ok());
  }
  ASSERT_TRUE((*bytes)->connected());
  EXPECT_FALSE((*bytes)->send(0, kBeat));
  bytes->reset();
  EXPECT_TRUE(other_end.receive().empty());  // closed without a byte

  TestLink link("udp-listen:127.0.0.1:0", options);
  PeerSocket peer(SOCK_DGRAM);
  ASSERT_TRUE(peer.connect_to(link.port()));
  ASSERT_TRUE(peer.send(attitude_frame(0)));
  ASSERT_TRUE(link.step_until_frames(1));
  const Status refused = link.link->send(kHeartbeatId, kBeat, 1);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("read-only"));
  EXPECT_EQ(link.link->counts().sent_bytes, 0U);
  EXPECT_FALSE(peer.readable(0));

  const Result<std::unique_ptr<FrameLink>> mute =
      FrameLink::create(*parse_link_address("udp:127.0.0.1:14550", "link"), options, {});
  ASSERT_FALSE(mute.ok());
  EXPECT_THAT(mute.error().message, HasSubstr("use udp-listen or tcp"));
}

TEST(FrameLink, SendsFirstByUdp) {
  PeerSocket vehicle(SOCK_DGRAM);
  const std::uint16_t port = vehicle.bind_to(0, false);
  TestLink link("udp:127.0.0.1:" + std::to_string(port));
  EXPECT_TRUE(link.link->send(kHeartbeatId, kBeat, 0).ok());
  EXPECT_THAT(sent_frames_in(vehicle.receive()), ElementsAre("255:0"));
}

TEST(FrameLink, ReadsASerialDevice) {
  const FileDescriptor terminal(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC));
  if (!terminal.open() || ::grantpt(terminal.get()) != 0 || ::unlockpt(terminal.get()) != 0) {
    GTEST_SKIP() << "no pseudo-terminal";
  }
  char name[128] = {};
  ASSERT_EQ(::ptsname_r(terminal.get(), name, sizeof name), 0);
  TestLink link("serial:" + std::string(name) + ":57600");
  ASSERT_TRUE(link.link->connected());
  // Bytes that a terminal would change: carriage return, line feed, interrupt, end, stop.
  Bytes payload = attitude_payload(0x0D0A0304, 1, 1, 1);
  payload[4] = 0x11;
  payload[5] = 0x13;
  const Bytes frame = frame_bytes(kAttitudeMessage, payload, 0x0D);
  ASSERT_EQ(::write(terminal.get(), frame.data(), frame.size()),
            static_cast<ssize_t>(frame.size()));
  ASSERT_TRUE(link.step_until_frames(1));
  EXPECT_THAT(link.frames, ElementsAre("1:13"));
  ASSERT_TRUE(link.link->send(kHeartbeatId, kBeat, 1).ok());
  Bytes got(1000);
  const ssize_t count = ::read(terminal.get(), got.data(), got.size());
  ASSERT_GT(count, 0);
  got.resize(static_cast<std::size_t>(count));
  EXPECT_THAT(sent_frames_in(got), ElementsAre("255:0"));
}

TEST(FrameLink, RejectsFilesThatAreNoSerialDevices) {
  const auto opened = open_byte_link(*parse_link_address("serial:/dev/null:57600", "link"), false);
  ASSERT_FALSE(opened.ok());
  EXPECT_THAT(opened.error().message, HasSubstr("is not a serial device"));
  TestLink missing("serial:/dev/no_such_device:57600");  // it may be plugged in later
  EXPECT_THAT(missing.link->counts().last_failure, HasSubstr("/dev/no_such_device"));
}

TEST(FrameLink, SignsAndVerifiesWithAKey) {
  LinkOptions options;
  options.key.emplace();
  options.sign = true;
  TestLink a("udp-listen:127.0.0.1:0", options);
  TestLink b("udp:127.0.0.1:" + std::to_string(a.port()), options);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(b.link->send(kHeartbeatId, kBeat, 0).ok());
  EXPECT_TRUE(a.step_until_frames(3));
  PeerSocket stranger(SOCK_DGRAM);
  ASSERT_TRUE(stranger.connect_to(a.port()));
  ASSERT_TRUE(stranger.send(attitude_frame(0)));
  ASSERT_TRUE(a.step_until([&] { return a.link->counts().refused_signatures == 1; }));
  EXPECT_EQ(a.frames.size(), 3U);
  EXPECT_EQ(a.link->senders().size(), 1U);

  options.version = Version::kOne;
  const auto impossible =
      FrameLink::create(*parse_link_address("udp-listen:127.0.0.1:0", "link"), options, {});
  ASSERT_FALSE(impossible.ok());
  EXPECT_THAT(impossible.error().message, HasSubstr("needs a key and MAVLink 2"));
}

TEST(FrameLink, WaitsLongerAfterEveryFailure) {
  BackOff back_off;
  std::vector<long> waits_ms;
  for (int i = 0; i < 6; ++i) waits_ms.push_back(back_off.next().count());
  EXPECT_THAT(waits_ms, ElementsAre(500, 1000, 2000, 4000, 8000, 8000));
  back_off.reset();
  EXPECT_EQ(back_off.next().count(), 500);
}

}  // namespace
}  // namespace overfly::flight::mavlink
