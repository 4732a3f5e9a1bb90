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
///
/// The first stamp has none before it to be compared with, and one that jumps ahead by more than
/// 2 s (of a slower clock: by more than two of its steps) may be damaged or come after a gap. Until
/// two more stamps follow such a one, the clock is not proven. If others are believed instead, the
/// unproven ones were wrong: they begin no run of the clock, and the time in front of a jump goes
/// on. Readers hold the messages of unproven stamps (HeldMessages) to take them back then.
class BootClock {
 public:
  /// Stamps in a row that agree and are then believed.
  static constexpr int kBelieved = 3;

  /// @return the time, or empty if the stamp is not plausible
  [[nodiscard]] std::optional<LogTime> take(std::int64_t t_ns);

  /// The latest time; empty before the first.
  [[nodiscard]] const std::optional<LogTime>& latest() const { return latest_; }
  /// Whether the latest stamps are known to be right or wrong.
  [[nodiscard]] bool proven() const { return first_ == kBelieved && !before_jump_ns_; }
  /// The stamps before the clock was proven for the first time were wrong.
  [[nodiscard]] bool first_were_wrong() const { return first_were_wrong_; }
  /// Whether a time that was given since the clock was proven last turned out to be wrong.
  [[nodiscard]] bool was_wrong(const LogTime& time) const {
    return right_until_ns_ && time.t_ns > *right_until_ns_;
  }
  /// Stamps that agree with each other, but not with the latest time: they may be believed.
  struct Suspicion {
    std::uint64_t number = 0;  ///< from 1 on
    std::int64_t t_ns = 0;     ///< the latest of its stamps
  };
  /// The suspicion that the latest stamp belongs to; empty if that stamp was plausible or believed.
  [[nodiscard]] std::optional<Suspicion> suspicion() const {
    return agreeing_ > 0 ? std::optional(Suspicion{suspicions_, suspect_ns_}) : std::nullopt;
  }
  /// Number of the suspicion whose stamps were believed last; 0: none.
  [[nodiscard]] std::uint64_t believed_suspicion() const { return believed_suspicion_; }
  [[nodiscard]] std::uint64_t implausible() const { return implausible_; }

 private:
  void follow(std::int64_t step_ns);
  [[nodiscard]] LogTime believe(std::int64_t t_ns);

  std::optional<LogTime> latest_;
  int first_ = 0;  ///< stamps taken since the first one, up to kBelieved
  std::optional<std::int64_t> before_jump_ns_;  ///< the latest time in front of an unproven jump
  int since_jump_ = 0;                          ///< stamps taken from that jump on
  std::int64_t least_step_ns_ = 0;              ///< of these
  std::int64_t usual_step_ns_ = 0;              ///< at least that of the last proven ones
  std::optional<std::int64_t> right_until_ns_;  ///< of the times that were not proven
  bool first_were_wrong_ = false;
  std::int64_t suspect_ns_ = 0;
  int agreeing_ = 0;
  std::uint64_t suspicions_ = 0;
  std::uint64_t believed_suspicion_ = 0;
  std::uint64_t implausible_ = 0;
};

}  // namespace overfly::flight::logs
