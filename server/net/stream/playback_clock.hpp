// The clock of one viewer, common to all runs that it watches: it plays forwards and backwards,
// pauses, seeks, repeats a range and follows a live run. Pure: the caller provides the time.
#pragma once

#include <cstdint>
#include <optional>

namespace overfly::net {

inline constexpr double kMinSpeed = 0.1;
inline constexpr double kMaxSpeed = 50.0;

class PlaybackClock {
 public:
  /// What can be played: the recorded time of all runs, by this clock.
  struct Extent {
    std::int64_t begin_ns = 0;
    std::int64_t end_ns = 0;
    bool flying = false;  ///< a run still flies
    /// Newest instant of the runs that fly; if none does, of those that have flown meanwhile.
    std::int64_t newest_ns = 0;
    bool operator==(const Extent&) const = default;
  };
  /// A part of it, A to B. @pre begin_ns < end_ns
  struct Range {
    std::int64_t begin_ns = 0;
    std::int64_t end_ns = 0;
    bool operator==(const Range&) const = default;
  };

  /// Follows a run that flies live; otherwise paused at the beginning.
  explicit PlaybackClock(const Extent& extent);
  /// With nothing to play.
  PlaybackClock() = default;

  /// When the last run ends, a live viewer is paused at the newest instant.
  void set_extent(const Extent& extent);
  /// Advances by the elapsed time times the speed. A clock that plays forwards at speed 1 or more
  /// and reaches the newest instant of a run that flies becomes live, at speed 1. At the end of the
  /// range, if it began inside it, else of the extent, it stops or loops.
  /// @param now_ns  monotonic wall clock
  void advance(std::int64_t now_ns);

  /// Starts to play; at the end, from the other end. Backwards if the speed is negative.
  void play();
  void pause();
  /// Clamped to the extent; leaves live mode. Does not change whether it plays.
  void seek(std::int64_t t_ns);
  /// Negative = backwards. Any speed other than 1 leaves live mode; a higher one becomes live again
  /// at once.
  /// @pre |speed| in [kMinSpeed, kMaxSpeed]
  void set_speed(double speed);
  void set_loop(bool loop) { loop_ = loop; }
  /// Empty = everything.
  void set_range(std::optional<Range> range) { range_ = range; }
  /// Follows the newest instant of a live run, at speed 1. @return false if none flies
  bool go_live();

  [[nodiscard]] std::int64_t t_ns() const { return t_ns_; }
  [[nodiscard]] const Extent& extent() const { return extent_; }
  [[nodiscard]] const std::optional<Range>& range() const { return range_; }
  [[nodiscard]] bool playing() const { return playing_; }
  [[nodiscard]] bool live() const { return live_; }
  [[nodiscard]] double speed() const { return speed_; }
  [[nodiscard]] bool loop() const { return loop_; }

 private:
  /// Where playback that is at t_ns now stops or loops.
  [[nodiscard]] Range bounds() const;
  /// True if playback within this range arrives at the newest instant of a run that flies.
  [[nodiscard]] bool reaches_newest(const Range& within) const;

  Extent extent_;
  std::optional<Range> range_;
  std::int64_t t_ns_ = 0;
  bool playing_ = false;
  bool live_ = false;
  bool loop_ = false;
  double speed_ = 1.0;
  std::optional<std::int64_t> last_now_ns_;
};

}  // namespace overfly::net
