// What a live vehicle says of itself, by its own clock.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "core/motion/flight_event.hpp"
#include "flight/mavlink/vehicle/vehicle.hpp"

namespace overfly::flight::live {

/// Keeps a report twice a second of the vehicle's clock, because a run in lockstep may be far
/// behind. Not thread-safe.
class VehicleReports {
 public:
  /// Takes the vehicle's state as it is now, if the next report is due.
  void add(const mavlink::Vehicle& vehicle, std::int64_t now_ns);
  /// The latest report up to a time of the vehicle's clock, which is also its t_ns; empty if there
  /// is none since the last call.
  [[nodiscard]] std::optional<VehicleStatus> take_until(std::int64_t t_ns);

 private:
  std::deque<VehicleStatus> waiting_;
  std::int64_t next_ns_ = 0;            ///< when the next report is due
  std::int64_t counted_ns_ = 0;         ///< time of the last report
  std::uint64_t counted_messages_ = 0;  ///< until then
};

}  // namespace overfly::flight::live
