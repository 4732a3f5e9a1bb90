// What a vehicle says about itself, for a viewer.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "flight/mavlink/messages.hpp"

namespace overfly::flight::mavlink {

/// The latest value of each kind; empty: never received.
struct VehicleState {
  std::uint8_t system = 0;
  std::uint8_t component = 0;
  std::optional<Heartbeat> heartbeat;
  std::string mode;                     ///< "mode 10 (AUTO)"
  std::optional<std::int64_t> boot_ns;  ///< latest time of the vehicle's clock in a message
  std::optional<double> battery_v;
  std::optional<int> battery_percent;
  std::optional<GpsRaw> gps;
  std::optional<GlobalPosition> position;  ///< of the vehicle's estimator
  std::optional<double> v_down_m_s;        ///< likewise
  std::optional<GlobalPosition> origin;    ///< of its local positions
  /// UTC since 1970 minus the vehicle's clock [ns], where the vehicle knows it.
  std::optional<std::int64_t> utc_minus_boot_ns;

  // Of the link, by sequence numbers:
  std::uint64_t messages = 0;
  std::uint64_t lost_messages = 0;
  std::uint64_t restarts = 0;  ///< times that the vehicle's clock went back by more than 2 s

  [[nodiscard]] bool armed() const { return heartbeat && heartbeat->armed(); }
};

/// Updates a state from a message of its vehicle.
void take_message(const Frame& frame, VehicleState& state);

}  // namespace overfly::flight::mavlink
