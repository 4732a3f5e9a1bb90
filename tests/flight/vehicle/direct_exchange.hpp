// A ground station for the tests of the simulated vehicle.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "flight/mavlink/vehicle/exchange.hpp"
#include "tests/flight/vehicle/cub_at_home.hpp"

namespace overfly::vehicle {

/// A ground station that talks to the vehicle without a network, in the vehicle's time.
class DirectExchange final : public flight::mavlink::Exchange {
 public:
  explicit DirectExchange(const VehicleSetup& setup = cub_at_home())
      : vehicle(SimulatedVehicle::create(setup).value()) {}

  [[nodiscard]] flight::mavlink::Target target() const override { return {1, 1, 3}; }
  [[nodiscard]] TimePoint now() const override {
    return TimePoint(std::chrono::duration_cast<TimePoint::duration>(
        std::chrono::nanoseconds(vehicle->report().boot_ns)));
  }
  [[nodiscard]] Status send(flight::mavlink::MessageId id,
                            const flight::mavlink::PayloadWriter& payload) override {
    pass(id, payload.bytes());
    return {};
  }
  [[nodiscard]] Result<std::optional<flight::mavlink::HeldMessage>> next(
      TimePoint deadline) override {
    while (inbox.empty()) {
      if (now() >= deadline) return std::optional<flight::mavlink::HeldMessage>();
      vehicle->step(keep_);
    }
    std::optional<flight::mavlink::HeldMessage> message = std::move(inbox.front());
    inbox.pop_front();
    return message;
  }
  void pass(flight::mavlink::MessageId id, std::span<const std::uint8_t> payload) {
    vehicle->take({flight::mavlink::Version::kTwo,
                   0,
                   255,
                   190,
                   static_cast<std::uint32_t>(id),
                   false,
                   payload},
                  keep_);
  }
  /// Steps until `done` or for at most `limit_s`; messages are counted and texts kept.
  void fly(double limit_s, const std::function<bool(const VehicleReport&)>& done) {
    for (int i = 0; i < static_cast<int>(limit_s * 100.0); ++i) {
      vehicle->step(keep_);
      collect();
      if (done(vehicle->report())) return;
    }
  }
  void collect() {
    for (const flight::mavlink::HeldMessage& message : inbox) {
      ++counts[static_cast<flight::mavlink::MessageId>(message.id)];
      if (message.is(flight::mavlink::MessageId::kStatusText))
        texts.push_back(message.reader().text(1, 50));
      if (message.is(flight::mavlink::MessageId::kMissionItemReached)) {
        reached.push_back(message.reader().at<std::uint16_t>(0));
      }
    }
    inbox.clear();
  }

  std::unique_ptr<SimulatedVehicle> vehicle;
  std::deque<flight::mavlink::HeldMessage> inbox;
  std::map<flight::mavlink::MessageId, int> counts;
  std::vector<std::string> texts;
  std::vector<std::uint16_t> reached;

 private:
  Send keep_ = [this](flight::mavlink::MessageId id,
                      const flight::mavlink::PayloadWriter& payload,
                      std::uint8_t /*system*/) {
    inbox.push_back({static_cast<std::uint32_t>(id), 1, payload.bytes()});
  };
};

}  // namespace overfly::vehicle
