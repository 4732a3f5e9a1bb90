// Where a playback goes, with what it sends.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "core/result.hpp"
#include "flight/playback/playback_clock.hpp"

namespace overfly::flight::playback {

struct PlaybackSummary {
  std::uint64_t sent = 0;    ///< messages
  std::uint64_t unsent = 0;  ///< messages that nobody took
};

/// Messages of a recording in the order of their times, as often as wanted, and those who listen.
class PlaybackOutput {
 public:
  using TimePoint = PlaybackClock::TimePoint;

  virtual ~PlaybackOutput() = default;

  /// @param stop  ends a wait; may be null
  /// Errors: those of the link, network or master.
  virtual Status open(const std::atomic<bool>* stop) = 0;
  /// Where it sends to; once it is open with the actual port.
  [[nodiscard]] virtual std::string place() const = 0;
  /// Waits at most `patience`, and hears who listens.
  virtual void wait(TimePoint now, std::chrono::milliseconds patience) = 0;
  /// Somebody listens, or nobody can be heard.
  [[nodiscard]] virtual bool is_heard() const = 0;

  /// Time of the next messages since the start of the recording, >= 0; empty at the end. Never
  /// decreases without a seek. Errors: those of the recording.
  [[nodiscard]] virtual Result<std::optional<std::int64_t>> next_us() = 0;
  /// Sends the messages of that time, and counts them. @pre next_us() gave a time
  /// Errors: those of the network.
  virtual Status send(PlaybackSummary& summary) = 0;
  /// Continues with the first message at or after a time. Errors: those of the recording.
  virtual Status seek(std::int64_t t_us) = 0;
  /// The playback is over: what waits is sent. Errors: those of the network.
  virtual Status finish() = 0;

  /// Time of the last message.
  [[nodiscard]] virtual std::int64_t duration_us() const = 0;
  [[nodiscard]] virtual std::uint64_t count() const = 0;
};

}  // namespace overfly::flight::playback
