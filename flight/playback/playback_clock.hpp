// Where a playback is: position, speed, pause.
#pragma once

#include <chrono>
#include <cstdint>

namespace overfly::flight::playback {

/// Positions are microseconds of the recording. Time is an argument.
class PlaybackClock {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// @param speed  seconds of the recording a second, > 0
  PlaybackClock(double speed, std::int64_t position_us, TimePoint now)
      : speed_(speed), from_us_(position_us), since_(now) {}

  [[nodiscard]] std::int64_t position_us(TimePoint now) const {
    if (paused_) return from_us_;
    const std::chrono::duration<double, std::micro> passed = now - since_;
    return from_us_ + static_cast<std::int64_t>(passed.count() * speed_);
  }
  void pause(TimePoint now) {
    move_to(position_us(now), now);
    paused_ = true;
  }
  void play(TimePoint now) {
    if (paused_) since_ = now;
    paused_ = false;
  }
  void set_speed(double speed, TimePoint now) {
    move_to(position_us(now), now);
    speed_ = speed;
  }
  void move_to(std::int64_t position_us, TimePoint now) {
    from_us_ = position_us;
    since_ = now;
  }
  [[nodiscard]] bool paused() const { return paused_; }
  [[nodiscard]] double speed() const { return speed_; }

 private:
  double speed_;
  std::int64_t from_us_;
  TimePoint since_;
  bool paused_ = false;
};

}  // namespace overfly::flight::playback
