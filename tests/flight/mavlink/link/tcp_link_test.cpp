// Connections by TCP: made again, one at a time, ended without a peer.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/tcp.h>

#include <string>

#include "flight/mavlink/link/open_byte_link.hpp"
#include "tests/flight/mavlink/link/peer_socket.hpp"
#include "tests/flight/mavlink/link/test_link.hpp"

namespace overfly::flight::mavlink {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::PeerSocket;

TEST(TcpLink, ConnectsByTcpAndAgainAfterFailures) {
  PeerSocket listener(SOCK_STREAM);
  const std::uint16_t port = listener.bind_to(0, true);
  ASSERT_NE(port, 0);
  TestLink link("tcp:127.0.0.1:" + std::to_string(port));
  PeerSocket vehicle = listener.accept();
  ASSERT_TRUE(vehicle.send(attitude_frame(0)));
  ASSERT_TRUE(link.step_until_frames(1));
  ASSERT_TRUE(link.link->send(kHeartbeatId, kBeat, 1).ok());
  EXPECT_THAT(sent_frames_in(vehicle.receive()), ElementsAre("255:0"));

  // The vehicle goes away with half a frame, and nobody listens.
  const Bytes frame = attitude_frame(1);
  ASSERT_TRUE(vehicle.send(std::span(frame).first(20)));
  vehicle.close();
  listener.close();
  ASSERT_TRUE(link.step_until([&] { return !link.link->connected(); }));
  EXPECT_THAT(link.link->counts().last_failure, HasSubstr("closed by the other side"));
  EXPECT_EQ(link.link->counts().failures, 1U);
  link.step();
  EXPECT_EQ(link.link->counts().failures, 1U);  // not again before half a second has passed
  link.now += milliseconds(500);
  ASSERT_TRUE(link.step_until([&] { return link.link->counts().failures == 2; }));
  EXPECT_THAT(link.link->counts().last_failure, HasSubstr("refused"));

  PeerSocket again(SOCK_STREAM);
  ASSERT_EQ(again.bind_to(port, true), port);
  link.now += milliseconds(999);
  link.step();
  EXPECT_EQ(again.readable(0), false);
  link.now += milliseconds(1);
  link.step();
  PeerSocket back = again.accept();
  ASSERT_TRUE(back.send(attitude_frame(2)));
  ASSERT_TRUE(link.step_until_frames(2));
  EXPECT_THAT(link.frames, ElementsAre("1:0", "1:2"));
}

TEST(TcpLink, GivesUpConnectingAfterFiveSeconds) {
  // A backlog that is full answers nothing.
  PeerSocket listener(SOCK_STREAM);
  const std::uint16_t port = listener.bind_to(0, false);
  ASSERT_EQ(::listen(listener.get(), 0), 0);
  std::vector<PeerSocket> filling;
  for (int i = 0; i < 4; ++i) {
    filling.emplace_back(SOCK_STREAM);
    ::fcntl(filling.back().get(), F_SETFL, O_NONBLOCK);
    (void)filling.back().connect_to(port);
  }
  TestLink link("tcp:127.0.0.1:" + std::to_string(port));
  link.step();
  if (link.link->connected()) GTEST_SKIP() << "this system's backlog cannot be filled";
  link.now += milliseconds(5001);
  link.step();
  EXPECT_THAT(link.link->counts().last_failure, HasSubstr("no answer within 5 s"));
}

TEST(TcpLink, ListensForOneTcpConnectionAtATime) {
  TestLink link("tcp-listen:127.0.0.1:0");
  PeerSocket vehicle(SOCK_STREAM);
  ASSERT_TRUE(vehicle.connect_to(link.port()));
  ASSERT_TRUE(vehicle.send(attitude_frame(0)));
  ASSERT_TRUE(link.step_until_frames(1));
  PeerSocket intruder(SOCK_STREAM);
  ASSERT_TRUE(intruder.connect_to(link.port()));
  ASSERT_TRUE(intruder.send(attitude_frame(7, 66)));
  ASSERT_TRUE(link.step_until([&] { return intruder.readable(0); }));
  EXPECT_TRUE(intruder.receive().empty());  // closed
  ASSERT_TRUE(vehicle.send(attitude_frame(1)));
  ASSERT_TRUE(link.step_until_frames(2));
  EXPECT_THAT(link.frames, ElementsAre("1:0", "1:1"));
  vehicle.close();
  PeerSocket next(SOCK_STREAM);
  ASSERT_TRUE(link.step_until([&] { return !link.link->connected(); }));
  ASSERT_TRUE(next.connect_to(link.port()));
  ASSERT_TRUE(next.send(attitude_frame(2)));
  EXPECT_TRUE(link.step_until_frames(3));
}

TEST(TcpLink, GivesTheOnlyPlaceOfASilentConnectionToANewOne) {
  for (const bool keeps_silent_peers : {false, true}) {
    LinkOptions options;
    options.keeps_silent_peers = keeps_silent_peers;
    TestLink link("tcp-listen:127.0.0.1:0", options);
    PeerSocket silent(SOCK_STREAM);
    ASSERT_TRUE(silent.connect_to(link.port()));
    link.now += milliseconds(5000);
    const Bytes half = attitude_frame(1);
    ASSERT_TRUE(silent.send(std::span(half).first(20)));
    ASSERT_TRUE(link.step_until([&] { return link.link->counts().received_bytes == 20; }));
    link.now += milliseconds(10000);
    PeerSocket early(SOCK_STREAM);
    ASSERT_TRUE(early.connect_to(link.port()));
    ASSERT_TRUE(link.step_until([&] { return early.readable(0); }));
    EXPECT_TRUE(early.receive().empty());  // closed
    EXPECT_FALSE(silent.readable(0));
    link.now += milliseconds(1);
    PeerSocket next(SOCK_STREAM);
    ASSERT_TRUE(next.connect_to(link.port()));
    ASSERT_TRUE(next.send(attitude_frame(2)));
    PeerSocket& closed = keeps_silent_peers ? next : silent;
    ASSERT_TRUE(link.step_until([&] { return closed.readable(0); }));
    EXPECT_TRUE(closed.receive().empty());
    if (keeps_silent_peers) continue;
    ASSERT_TRUE(link.step_until_frames(1));
    EXPECT_THAT(link.frames, ElementsAre("1:2"));
    EXPECT_EQ(link.link->counts().bad_checksums, 0U);
    EXPECT_EQ(link.link->counts().skipped_bytes, 20U);
  }
}

/// A machine that is switched off closes no connection.
TEST(TcpLink, EndsTcpConnectionsThatNobodyAcknowledges) {
  const auto connection_of = [](const ByteLink& link) {
    std::vector<pollfd> descriptors;
    link.add_to_poll(descriptors);
    return descriptors.back().fd;
  };
  const auto expect_limits = [](int socket) {
    int value = 0;
    socklen_t size = sizeof value;
    ASSERT_EQ(::getsockopt(socket, SOL_SOCKET, SO_KEEPALIVE, &value, &size), 0);
    EXPECT_EQ(value, 1);
    ASSERT_EQ(::getsockopt(socket, IPPROTO_TCP, TCP_KEEPIDLE, &value, &size), 0);
    EXPECT_EQ(value, 5);
    ASSERT_EQ(::getsockopt(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, &value, &size), 0);
    EXPECT_EQ(value, 10000);
    ASSERT_EQ(::getsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &value, &size), 0);
    EXPECT_NE(value, 0);
  };
  auto listening = open_byte_link(*parse_link_address("tcp-listen:127.0.0.1:0", "link"), false);
  ASSERT_TRUE(listening.ok());
  const std::string port = std::to_string((*listening)->address().port);
  auto connected = open_byte_link(*parse_link_address("tcp:127.0.0.1:" + port, "link"), false);
  ASSERT_TRUE(connected.ok());
  for (int i = 0; i < 500 && !(*listening)->connected(); ++i) {
    std::vector<pollfd> descriptors;
    (*listening)->add_to_poll(descriptors);
    (void)::poll(descriptors.data(), descriptors.size(), 10);
    ASSERT_TRUE((*listening)
                    ->exchange(
                        {}, [](PeerId, std::span<const std::uint8_t>) {}, [](PeerId) {})
                    .ok());
  }
  ASSERT_TRUE((*listening)->connected());
  expect_limits(connection_of(**listening));
  expect_limits(connection_of(**connected));
}

}  // namespace
}  // namespace overfly::flight::mavlink
