// A vehicle that is prepared, armed and started over the loopback interface.
#include "flight/live/fly_live.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "flight/mavlink/frame_finder.hpp"
#include "flight/mavlink/message_table.hpp"
#include "tests/flight/logs/log_bytes.hpp"
#include "tests/flight/mavlink/link/peer_socket.hpp"
#include "tests/flight/mavlink/vehicle/fake_vehicle.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight::live {
namespace {

using mavlink::PayloadWriter;
using testing::append;
using testing::Bytes;
using testing::frame_bytes;
using ::testing::HasSubstr;
using testing::PeerSocket;

/// Answers over TCP as FakeVehicle does, and flies once it is armed.
class TcpVehicle {
 public:
  TcpVehicle() : listener_(SOCK_STREAM) {
    port_ = listener_.bind_to(0, true);
    fake.parameters["AIRSPEED_CRUISE"] = {"AIRSPEED_CRUISE", 22.0, 9};
  }
  ~TcpVehicle() { stop(); }

  void start() {
    thread_ = std::thread([this] { run(); });
  }
  void stop() {
    stops_ = true;
    if (thread_.joinable()) thread_.join();
  }
  [[nodiscard]] std::uint16_t port() const { return port_; }

  testing::FakeVehicle fake;  ///< not to be touched while the vehicle runs
  std::uint64_t received_bytes = 0;

 private:
  void run() {
    PeerSocket socket = listener_.accept();
    Bytes waiting;
    std::uint8_t sequence = 0;
    std::uint32_t boot_ms = 1000;
    const auto send = [&](std::uint32_t id, const Bytes& payload) {
      return socket.send(frame_bytes(id, payload, sequence++));
    };
    while (!stops_) {
      boot_ms += 20;
      PayloadWriter heartbeat(9);
      heartbeat.put(0, fake.mode).put(4, std::uint8_t{1}).put(5, std::uint8_t{3});
      heartbeat.put(6, static_cast<std::uint8_t>(fake.armed ? 0x81 : 0x01));
      bool alive = send(0, heartbeat.bytes());
      alive = alive && send(30, testing::attitude_payload(boot_ms, 0.1F, 0.2F, 0.3F));
      alive = alive &&
              send(33, testing::global_position_payload(boot_ms, 100000000, 200000000, 300000));
      if (!alive) return;
      append(waiting, socket.receive(1));
      answer(waiting, send);
    }
  }

  template <typename Send>
  void answer(Bytes& waiting, const Send& send) {
    mavlink::FrameFinder finder;
    while (true) {
      const auto found = finder.next(waiting, false);
      if (found.frame) {
        received_bytes += found.bytes.size();
        PayloadWriter payload(280);
        for (std::size_t i = 0; i < found.frame->payload.size(); ++i) {
          payload.put(i, found.frame->payload[i]);
        }
        (void)fake.send(static_cast<mavlink::MessageId>(found.frame->message_id), payload);
      }
      waiting.erase(waiting.begin(),
                    waiting.begin() + static_cast<std::ptrdiff_t>(found.consumed_bytes));
      if (!found.frame) break;
    }
    while (true) {
      const auto message = fake.next(fake.now());
      if (!message.ok() || !*message) return;
      Bytes payload = (*message)->payload;
      const auto* const facts = mavlink::message_facts((*message)->id);
      payload.resize(std::min<std::size_t>(payload.size(), facts->full_bytes));
      (void)send((*message)->id, payload);
    }
  }

  PeerSocket listener_;
  std::uint16_t port_ = 0;
  std::atomic<bool> stops_{false};
  std::thread thread_;
};

LiveFlight flight_to(const TcpVehicle& vehicle) {
  LiveFlight flight;
  flight.link =
      *mavlink::parse_link_address("tcp:127.0.0.1:" + std::to_string(vehicle.port()), "link");
  flight.truth.simulation_wait_ns = kNsPerS / 10;
  return flight;
}

const LocalFrame kLiveFrame(geodetic_from_deg(10.0, 20.0, 0.0));

TEST(FlyLive, PreparesArmsAndStartsTheVehicle) {
  overfly::testing::TemporaryFolder folder;
  const auto mission = folder.path() / "some.waypoints";
  overfly::testing::write_text(mission,
                               "QGC WPL 110\n"
                               "0 1 0 16 0 0 0 0 10 20 0 1\n"
                               "1 0 3 22 15 0 0 0 10.001 20 60 1\n"
                               "2 0 3 16 0 0 0 0 10.01 20.01 300 1\n");
  TcpVehicle vehicle;
  vehicle.start();
  LiveFlight flight = flight_to(vehicle);
  flight.rate_hz = 50.0;
  flight.parameters["AIRSPEED_CRUISE"] = 25.0;
  flight.mission_file = mission;
  flight.arm_and_start = true;
  const auto truth = fly_live(flight, kLiveFrame, nullptr);
  ASSERT_TRUE(truth.ok()) << truth.error().message;
  const auto state = (*truth)->state_at(kNsPerS / 2);
  ASSERT_TRUE(state.ok()) << state.error().message;
  ASSERT_TRUE(state->has_value());
  EXPECT_LT(((*state)->T_world_body.translation - Eigen::Vector3d(0, 0, 300)).norm(), 1e-6);
  const RollPitchYaw attitude = attitude_from((*state)->T_world_body.rotation);
  EXPECT_NEAR(attitude.roll_rad, 0.1, 1e-6);
  EXPECT_NEAR(attitude.pitch_rad, 0.2, 1e-6);
  EXPECT_NEAR(attitude.yaw_rad, 0.3, 1e-6);
  vehicle.stop();
  EXPECT_TRUE(vehicle.fake.armed);
  EXPECT_EQ(vehicle.fake.parameters["AIRSPEED_CRUISE"].value, 25.0);
  EXPECT_EQ(vehicle.fake.mission.size(), 3U);
  std::vector<int> commands;
  for (const auto& payload : vehicle.fake.commands) {
    commands.push_back(mavlink::PayloadReader(payload).at<std::uint16_t>(28));
  }
  EXPECT_THAT(commands, ::testing::ElementsAre(511, 511, 511, 511, 511, 400, 300));
}

TEST(FlyLive, SendsNothingOnAReadOnlyLink) {
  TcpVehicle vehicle;
  vehicle.start();
  LiveFlight flight = flight_to(vehicle);
  flight.read_only = true;
  const auto truth = fly_live(flight, kLiveFrame, nullptr);
  ASSERT_TRUE(truth.ok()) << truth.error().message;
  EXPECT_TRUE((*truth)->state_at(kNsPerS / 2).ok());
  vehicle.stop();
  EXPECT_EQ(vehicle.received_bytes, 0U);
}

TEST(FlyLive, SaysWhatTheVehicleRefuses) {
  TcpVehicle vehicle;
  vehicle.start();
  LiveFlight flight = flight_to(vehicle);
  flight.parameters["NO_SUCH"] = 1.0;
  const auto truth = fly_live(flight, kLiveFrame, nullptr);
  ASSERT_FALSE(truth.ok());
  EXPECT_THAT(truth.error().message, HasSubstr(flight.link.text() + ": reading parameter NO_SUCH"));
  EXPECT_EQ(truth.error().code, ErrorCode::kNotFound);
}

}  // namespace
}  // namespace overfly::flight::live
