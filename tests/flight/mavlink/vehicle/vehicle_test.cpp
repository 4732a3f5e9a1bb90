// A session over the loopback interface.
#include "flight/mavlink/vehicle/vehicle.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "flight/mavlink/frame_finder.hpp"
#include "flight/mavlink/vehicle/commands.hpp"
#include "flight/mavlink/vehicle/parameters.hpp"
#include "tests/flight/logs/log_bytes.hpp"
#include "tests/flight/mavlink/link/peer_socket.hpp"

namespace overfly::flight::mavlink {
namespace {

using std::chrono::milliseconds;
using testing::Bytes;
using testing::frame_bytes;
using ::testing::HasSubstr;
using testing::PeerSocket;

Bytes heartbeat_frame(std::uint8_t system, std::uint8_t sequence, std::uint32_t mode = 10) {
  Bytes payload = PayloadWriter(9)
                      .put(0, mode)
                      .put(4, std::uint8_t{1})
                      .put(5, std::uint8_t{3})
                      .put(6, std::uint8_t{0x81})
                      .bytes();
  return frame_bytes(0, payload, sequence, system);
}

/// A vehicle at the other end of a session that listens by UDP.
struct SessionTest {
  std::unique_ptr<Vehicle> session;
  PeerSocket peer{SOCK_DGRAM};

  explicit SessionTest(VehicleOptions options = {}) {
    Result<std::unique_ptr<Vehicle>> opened =
        Vehicle::open(*parse_link_address("udp-listen:127.0.0.1:0", "link"), options);
    EXPECT_TRUE(opened.ok());
    session = std::move(*opened);
    EXPECT_TRUE(peer.connect_to(session->address().port));
  }
  /// Waits until the session knows something.
  template <typename Done>
  bool wait_until(const Done& done) {
    for (int i = 0; i < 1000 && !done(); ++i) std::this_thread::sleep_for(milliseconds(5));
    return done();
  }
};

TEST(Vehicle, KnowsWhatTheVehicleSays) {
  SessionTest test;
  ASSERT_TRUE(test.peer.send(heartbeat_frame(1, 0)));
  ASSERT_TRUE(test.session->wait_until_heard(milliseconds(5000), nullptr).ok());
  const Bytes position = testing::global_position_payload(1000, -353632620, 1491652370, 584000);
  ASSERT_TRUE(test.peer.send(frame_bytes(33, position, 3)));  // 1 and 2 are lost
  ASSERT_TRUE(test.peer.send(frame_bytes(30, testing::attitude_payload(1010, 0.1F, 0, 1), 4)));
  ASSERT_TRUE(test.peer.send(frame_bytes(
      1, PayloadWriter(43).put(14, std::uint16_t{12600}).put(30, std::int8_t{77}).bytes(), 5)));
  // Another vehicle changes nothing.
  ASSERT_TRUE(test.peer.send(heartbeat_frame(2, 0, 5)));
  ASSERT_TRUE(
      test.peer.send(frame_bytes(253, PayloadWriter(54).put_text(1, "hello", 50).bytes(), 6)));
  ASSERT_TRUE(test.wait_until([&] { return test.session->state().messages == 5; }));
  ASSERT_TRUE(test.wait_until([&] { return test.session->state().lost_messages == 2; }));
  const VehicleState state = test.session->state();
  EXPECT_EQ(state.system, 1);
  EXPECT_EQ(state.mode, "mode 10 (AUTO)");
  EXPECT_TRUE(state.armed());
  EXPECT_EQ(state.boot_ns, 1010 * std::int64_t{1'000'000});
  EXPECT_EQ(state.battery_v, 12.6);
  EXPECT_EQ(state.battery_percent, 77);
  ASSERT_TRUE(state.position);
  EXPECT_NEAR(state.position->lat_deg, -35.363262, 1e-9);
}

TEST(Vehicle, TalksToTheVehicle) {
  SessionTest test;
  ASSERT_TRUE(test.peer.send(heartbeat_frame(1, 0)));
  ASSERT_TRUE(test.session->wait_until_heard(milliseconds(5000), nullptr).ok());
  // The vehicle's side: acknowledges commands, tells its time, asks for the time.
  std::thread vehicle([&test] {
    std::uint8_t sequence = 0;
    bool acknowledged = false;
    bool told_time = false;
    int answered_times = 0;
    std::int64_t vehicle_ns = 5'000'000'000;
    while (!acknowledged || !told_time) {
      const Bytes datagram = test.peer.receive();
      if (datagram.empty()) return;
      FrameFinder finder;
      const auto found = finder.next(datagram, true);
      if (!found.frame) continue;
      const PayloadReader payload(found.frame->payload);
      if (found.frame->message_id == 76) {
        acknowledged = true;
        (void)test.peer.send(frame_bytes(
            77, PayloadWriter(10).put(0, payload.at<std::uint16_t>(28)).bytes(), ++sequence));
      } else if (found.frame->message_id == 111 && payload.at<std::int64_t>(0) == 0) {
        // The session asks for the time.
        vehicle_ns += 100'000'000;
        (void)test.peer.send(frame_bytes(
            111,
            PayloadWriter(18).put(0, vehicle_ns).put(8, payload.at<std::int64_t>(8)).bytes(),
            ++sequence));
        if (++answered_times >= 6) {
          (void)test.peer.send(
              frame_bytes(111, PayloadWriter(18).put(8, std::int64_t{777}).bytes(), ++sequence));
        }
      } else if (found.frame->message_id == 111) {
        EXPECT_EQ(payload.at<std::int64_t>(8), 777);
        told_time = payload.at<std::int64_t>(0) > 5'000'000'000;
      }
    }
  });
  const auto exchange = test.session->converse(nullptr);
  const Status started = start_mission(*exchange);
  EXPECT_TRUE(started.ok()) << started.error().message;
  vehicle.join();
  const std::optional<VehicleClock> clock = test.session->clock();
  ASSERT_TRUE(clock);
  EXPECT_GT(clock->vehicle_ns, 5'000'000'000);
}

TEST(Vehicle, IsNotAnsweredByWhatItTellsOtherGroundStations) {
  SessionTest test;
  ASSERT_TRUE(test.peer.send(heartbeat_frame(1, 0)));
  ASSERT_TRUE(test.session->wait_until_heard(milliseconds(5000), nullptr).ok());
  std::thread vehicle([&test] {
    while (true) {
      const Bytes datagram = test.peer.receive();
      if (datagram.empty()) return;
      FrameFinder finder;
      const auto found = finder.next(datagram, true);
      if (!found.frame || found.frame->message_id != 76) continue;
      const auto command = PayloadReader(found.frame->payload).at<std::uint16_t>(28);
      const auto acknowledge =
          [&](std::uint8_t result, std::uint8_t system, std::uint8_t component) {
            (void)test.peer.send(frame_bytes(77,
                                             PayloadWriter(10)
                                                 .put(0, command)
                                                 .put(2, result)
                                                 .put(8, system)
                                                 .put(9, component)
                                                 .bytes(),
                                             1));
          };
      acknowledge(2, 254, 190);
      acknowledge(3, 255, 230);
      acknowledge(0, 255, 190);
      return;
    }
  });
  const auto exchange = test.session->converse(nullptr);
  const Status started = start_mission(*exchange);
  EXPECT_TRUE(started.ok()) << started.error().message;
  vehicle.join();
}

TEST(Vehicle, SaysWhatWasHeardInsteadOfAVehicle) {
  VehicleOptions options;
  options.system = 9;
  SessionTest test(options);
  const auto message = [&] {
    return test.session->wait_until_heard(milliseconds(1), nullptr).error().message;
  };
  EXPECT_THAT(message(), HasSubstr("no heartbeat of system 9 within 1 ms: nothing was heard"));
  ASSERT_TRUE(test.peer.send(Bytes{1, 2, 3}));
  EXPECT_TRUE(test.wait_until([&] {
    return message().find("3 bytes came, but no valid MAVLink message") != std::string::npos;
  }));
  ASSERT_TRUE(test.peer.send(heartbeat_frame(1, 0)));
  EXPECT_TRUE(test.wait_until(
      [&] { return message().find("only from 1.1, none from system 9") != std::string::npos; }));
  const std::atomic<bool> cancel{true};
  EXPECT_EQ(test.session->wait_until_heard(milliseconds(60000), &cancel).error().code,
            ErrorCode::kCancelled);
  EXPECT_EQ(test.session->send(MessageId::kCommandLong, PayloadWriter(33)).error().code,
            ErrorCode::kConflict);
}

TEST(Vehicle, IsSilentOnAReadOnlyLink) {
  VehicleOptions options;
  options.link.read_only = true;
  SessionTest test(options);
  ASSERT_TRUE(test.peer.send(heartbeat_frame(1, 0)));
  ASSERT_TRUE(test.session->wait_until_heard(milliseconds(5000), nullptr).ok());
  ASSERT_TRUE(
      test.peer.send(frame_bytes(111, PayloadWriter(18).put(8, std::int64_t{777}).bytes(), 1)));
  ASSERT_TRUE(test.peer.send(heartbeat_frame(1, 2, 11)));
  ASSERT_TRUE(test.wait_until([&] { return test.session->state().mode == "mode 11 (RTL)"; }));
  const auto exchange = test.session->converse(nullptr);
  const Status refused = arm(*exchange, std::chrono::seconds(1));
  EXPECT_EQ(refused.error().code, ErrorCode::kConflict);
  EXPECT_THAT(refused.error().message, HasSubstr("the link is read-only"));
  EXPECT_FALSE(test.peer.readable(0));
  EXPECT_EQ(test.session->link_counts().sent_bytes, 0U);
}

}  // namespace
}  // namespace overfly::flight::mavlink
