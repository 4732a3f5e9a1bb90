// The clock of a vehicle, from TIMESYNC.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

namespace overfly::flight::mavlink {

/// Estimates the vehicle's clock from the local one.
///
/// Each answer of the vehicle states its time between two local times; the middle is assumed. A
/// line is fitted to the latest 32 answers, each weighted with the inverse square of its round
/// trip, because a slow answer says less. The line's slope is not 1 in simulations that run faster
/// than real time.
/// A vehicle that restarts, or an answer that is more than 1 s off the line, starts the estimate
/// again.
class TimeSync {
 public:
  /// An answer. Left out: round trips that are negative or longer than 10 s.
  /// @param sent_ns, received_ns  local clock
  void take(std::int64_t sent_ns, std::int64_t vehicle_ns, std::int64_t received_ns);

  /// The vehicle's time; empty before four answers over 0.2 s.
  [[nodiscard]] std::optional<std::int64_t> vehicle_ns_at(std::int64_t local_ns) const;
  /// Seconds of the vehicle per local second. @pre vehicle_ns_at() is not empty
  [[nodiscard]] double rate() const { return rate_; }
  /// The shortest round trip of the answers in use; empty before the first.
  [[nodiscard]] std::optional<std::int64_t> round_trip_ns() const;
  [[nodiscard]] std::uint64_t restarts() const { return restarts_; }

 private:
  struct Answer {
    std::int64_t local_ns = 0;
    std::int64_t vehicle_ns = 0;
    std::int64_t round_trip_ns = 0;
  };
  void fit();

  std::deque<Answer> answers_;
  bool fitted_ = false;
  double rate_ = 1.0;
  std::int64_t base_local_ns_ = 0;  ///< a point of the line
  std::int64_t base_vehicle_ns_ = 0;
  std::uint64_t restarts_ = 0;
};

}  // namespace overfly::flight::mavlink
