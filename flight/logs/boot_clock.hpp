// The clock of a vehicle as seen in its log: restarts and damaged stamps.
#pragma once

#include <cstdint>
#include <optional>

#include "flight/logs/log_sink.hpp"

namespace overfly::flight::logs {

/// What a reader does with the messages of a clock's first stamps, which nothing confirms yet.
enum class FirstStamps {
  kPassed,  ///< passes them on at once
  kHeld,    ///< holds them (HeldMessages) until the clock is proven
};

/// Follows a clock that counts from the vehicle's start, and notices its restarts.
///
/// A stamp is plausible if it lies at most 2 s before the latest one (messages are logged slightly
/// out of order) and at most 600 s after it. Three stamps in a row within 10 s of each other are
/// believed although they are not: earlier ones as a restart, later ones as a gap of the log. All
/// others are counted and left out, because records of DataFlash have no checksum.
///
/// The first stamp has none before it to be compared with. If stamps are believed instead of fewer
/// than three first ones, those first ones were wrong: they begin no run of the clock. Only a
/// reader that holds their messages can still take them back.
class BootClock {
 public:
  /// Stamps in a row that agree and are then believed.
  static constexpr int kBelieved = 3;

  explicit BootClock(FirstStamps first_stamps = FirstStamps::kPassed)
      : first_stamps_(first_stamps) {}

  /// @return the time, or empty if the stamp is not plausible
  [[nodiscard]] std::optional<LogTime> take(std::int64_t t_ns);

  /// The latest time; empty before the first.
  [[nodiscard]] const std::optional<LogTime>& latest() const { return latest_; }
  /// Whether the first stamps are known to be right or wrong; always if they are passed on.
  [[nodiscard]] bool proven() const {
    return first_stamps_ == FirstStamps::kPassed || first_ == kBelieved;
  }
  /// The stamps before the clock was proven were wrong.
  [[nodiscard]] bool first_were_wrong() const { return first_were_wrong_; }
  [[nodiscard]] std::uint64_t implausible() const { return implausible_; }

 private:
  FirstStamps first_stamps_;
  std::optional<LogTime> latest_;
  int first_ = 0;  ///< stamps taken since the first one, up to kBelieved
  bool first_were_wrong_ = false;
  std::int64_t suspect_ns_ = 0;
  int agreeing_ = 0;
  std::uint64_t implausible_ = 0;
};

}  // namespace overfly::flight::logs
