// Where one viewer is in a run: a cursor over recorded time that plays, pauses, seeks and follows
// a live run. Pure: the caller gives the clock.
#pragma once

#include <cstdint>
#include <optional>

namespace overfly::net {

inline constexpr double kMinSpeed = 0.1;
inline constexpr double kMaxSpeed = 50.0;

class PlaybackCursor {
 public:
  /// A running run is followed live; a finished one waits paused at 0.
  explicit PlaybackCursor(bool running) : running_(running), playing_(running), live_(running) {}

  /// What is recorded by now: [0, end_ns], which grows while `running`.
  /// A live viewer of a run that ends stands paused at its end.
  void set_extent(std::int64_t end_ns, bool running);
  /// Moves by the time since the last call times the speed, within what is recorded. One that
  /// catches up with a running run becomes live; at the end of a finished one it stops or loops.
  /// @param now_ns  monotonic wall clock
  void advance(std::int64_t now_ns);

  /// Plays on; from the start again when a finished run is at its end.
  void play();
  void pause();
  /// Clamped to what is recorded; leaves live. Plays on if it played.
  void seek(std::int64_t t_ns);
  /// @pre speed in [kMinSpeed, kMaxSpeed]. Any speed but 1 leaves live.
  void set_speed(double speed);
  void set_loop(bool loop) { loop_ = loop; }
  /// Follows the newest instant of a running run. @return false when it is not running
  bool go_live();

  [[nodiscard]] std::int64_t t_ns() const { return t_ns_; }
  [[nodiscard]] std::int64_t end_ns() const { return end_ns_; }
  [[nodiscard]] bool playing() const { return playing_; }
  [[nodiscard]] bool live() const { return live_; }
  [[nodiscard]] bool running() const { return running_; }
  [[nodiscard]] double speed() const { return speed_; }
  [[nodiscard]] bool loop() const { return loop_; }

 private:
  void arrive_at_end(std::int64_t beyond_ns);

  std::int64_t t_ns_ = 0;
  std::int64_t end_ns_ = 0;
  bool running_ = false;
  bool playing_ = false;
  bool live_ = false;
  bool loop_ = false;
  double speed_ = 1.0;
  std::optional<std::int64_t> last_now_ns_;
};

}  // namespace overfly::net
