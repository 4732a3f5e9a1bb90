// The clock of a vehicle as seen in its log: restarts and damaged stamps.
#pragma once

#include <cstdint>
#include <optional>

#include "flight/logs/log_sink.hpp"

namespace overfly::flight::logs {

/// Follows a clock that counts from the vehicle's start, and notices its restarts.
///
/// A stamp is plausible if it lies at most 2 s before the latest one (messages are logged slightly
/// out of order) and at most 600 s after it. Three stamps in a row within 10 s of each other are
/// believed although they are not: earlier ones as a restart, later ones as a gap of the log. All
/// others are counted and left out, because records of DataFlash have no checksum.
class BootClock {
 public:
  /// @return the time, or empty if the stamp is not plausible
  [[nodiscard]] std::optional<LogTime> take(std::int64_t t_ns);

  /// The latest time; empty before the first.
  [[nodiscard]] const std::optional<LogTime>& latest() const { return latest_; }
  [[nodiscard]] std::uint64_t implausible() const { return implausible_; }

 private:
  std::optional<LogTime> latest_;
  std::int64_t suspect_ns_ = 0;
  int agreeing_ = 0;
  std::uint64_t implausible_ = 0;
};

}  // namespace overfly::flight::logs
