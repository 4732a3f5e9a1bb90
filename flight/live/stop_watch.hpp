// Notices the end of a live flight.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "flight/live/live_options.hpp"
#include "flight/mavlink/frame.hpp"

namespace overfly::flight::live {

/// Compares the messages of a vehicle with stop conditions.
class StopWatch {
 public:
  explicit StopWatch(const StopConditions& conditions) : conditions_(conditions) {}

  /// @return why the flight has ended; empty while it goes on
  [[nodiscard]] std::string take(const mavlink::Frame& frame);

 private:
  StopConditions conditions_;
  bool was_armed_ = false;
  bool was_in_air_ = false;
  std::optional<std::uint16_t> item_;  ///< of the mission, reported last
};

}  // namespace overfly::flight::live
