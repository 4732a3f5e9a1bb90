// A vehicle on the loopback interface with its messages made by hand, and the truth that listens to
// it, for tests.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "flight/live/live_truth.hpp"
#include "flight/mavlink/link/frame_recorder.hpp"
#include "flight/mavlink/payload.hpp"
#include "tests/flight/logs/log_bytes.hpp"
#include "tests/flight/mavlink/link/peer_socket.hpp"

namespace overfly::flight::live {

inline constexpr double kLat0 = -35.363262;
inline constexpr double kLon0 = 149.165237;

inline LocalFrame frame_at_start() { return LocalFrame(geodetic_from_deg(kLat0, kLon0, 600.0)); }

inline std::shared_ptr<mavlink::Vehicle> listening_vehicle(
    const std::string& address, std::shared_ptr<mavlink::FrameRecorder> recorder = nullptr) {
  mavlink::VehicleOptions options;
  options.link.recorder = std::move(recorder);
  options.link.read_only = true;
  Result<std::unique_ptr<mavlink::Vehicle>> opened =
      mavlink::Vehicle::open(*mavlink::parse_link_address(address, "link"), options);
  EXPECT_TRUE(opened.ok()) << opened.error().message;
  return std::move(*opened);
}

/// A vehicle that flies north at 25 m/s and turns its yaw, with its messages made by hand.
class MadeVehicle {
 public:
  explicit MadeVehicle(std::uint16_t port) { EXPECT_TRUE(socket_.connect_to(port)); }

  void send(const testing::Bytes& frame) { EXPECT_TRUE(socket_.send(frame)); }
  void heartbeat(bool armed = true) {
    send(testing::frame_bytes(0,
                              mavlink::PayloadWriter(9)
                                  .put(0, std::uint32_t{10})
                                  .put(4, std::uint8_t{1})
                                  .put(5, std::uint8_t{3})
                                  .put(6, static_cast<std::uint8_t>(armed ? 0x81 : 0x01))
                                  .bytes(),
                              sequence_++));
  }
  void attitude(std::uint32_t boot_ms) {
    send(testing::frame_bytes(
        30, testing::attitude_payload(boot_ms, 0.0F, 0.0F, yaw_at(boot_ms)), sequence_++));
  }
  void position(std::uint32_t boot_ms) { position(boot_ms, boot_ms); }
  /// Where the vehicle is at another time.
  void position(std::uint32_t boot_ms, std::uint32_t place_ms) {
    testing::Bytes payload;
    testing::put(payload, boot_ms);
    testing::put(payload, lat_at(place_ms));
    testing::put(payload, static_cast<std::int32_t>(std::lround(kLon0 * 1e7)));
    for (const std::int32_t alt_mm : {600000, 300000}) testing::put(payload, alt_mm);
    for (const std::int16_t value : {2500, 0, 0, 0}) testing::put(payload, value);
    send(testing::frame_bytes(33, payload, sequence_++));
  }
  /// SIM_STATE 100 m above the estimate; it has no time.
  void sim_state(std::uint32_t boot_ms) {
    mavlink::PayloadWriter payload(92);
    payload.put(0, 1.0F).put(60, 700.0F).put(72, 25.0F);
    payload.put(84, lat_at(boot_ms));
    payload.put(88, static_cast<std::int32_t>(std::lround(kLon0 * 1e7)));
    send(testing::frame_bytes(108, payload.bytes(), sequence_++));
  }
  void state(std::uint32_t boot_ms) {
    attitude(boot_ms);
    position(boot_ms);
  }
  static float yaw_at(std::uint32_t boot_ms) {
    return 0.1e-3F * static_cast<float>(boot_ms % 10000);
  }
  static std::int32_t lat_at(std::uint32_t boot_ms) {
    // 0.011131884502145034 m per 1e-7 deg.
    return static_cast<std::int32_t>(std::lround(kLat0 * 1e7 + 0.025 * boot_ms / 0.0111318845));
  }

 private:
  testing::PeerSocket socket_{SOCK_DGRAM};
  std::uint8_t sequence_ = 0;
};

struct OpenedTruth {
  std::shared_ptr<mavlink::Vehicle> vehicle;
  std::unique_ptr<MadeVehicle> made;
  std::unique_ptr<LiveTruth> truth;

  explicit OpenedTruth(LiveTruthOptions options = {}) {
    vehicle = listening_vehicle("udp-listen:127.0.0.1:0", options.recorder);
    made = std::make_unique<MadeVehicle>(vehicle->address().port);
    made->heartbeat();
    options.simulation_wait_ns = std::min(options.simulation_wait_ns, kNsPerS / 10);
    // Messages that were sent before the listener is set are lost to it: the vehicle goes on.
    std::atomic<bool> opened{false};
    std::thread flying([&] {
      for (std::uint32_t ms = 10000; !opened && ms < 60000; ms += 20) {
        made->state(ms);
        last_ms = ms;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
    Result<std::unique_ptr<LiveTruth>> result =
        LiveTruth::open(vehicle, frame_at_start(), options, nullptr);
    opened = true;
    flying.join();
    EXPECT_TRUE(result.ok()) << result.error().message;
    if (result.ok()) truth = std::move(*result);
  }
  /// A time of the vehicle's clock as a time of the flight.
  [[nodiscard]] std::int64_t flight_ns(std::uint32_t boot_ms) const {
    return std::int64_t{boot_ms} * 1'000'000 - truth->start_ns();
  }
  /// Sends states every 20 ms of the vehicle's clock, as fast as the session takes them: a socket
  /// holds some hundred messages.
  void fly_until(std::uint32_t boot_ms) {
    while (last_ms < boot_ms) {
      last_ms += 20;
      made->state(last_ms);
      if (last_ms % 500 < 20 || last_ms >= boot_ms) wait_for_session();
    }
  }
  void wait_for_session() const {
    const std::int64_t sent_ns = std::int64_t{last_ms} * 1'000'000;
    for (int i = 0; i < 5000 && vehicle->state().boot_ns.value_or(0) < sent_ns; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  std::uint32_t last_ms = 0;
};

}  // namespace overfly::flight::live
