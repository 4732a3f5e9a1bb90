// Position of one viewer in a run: a cursor over recorded time that plays, pauses, seeks and
// follows a live run. Pure: the caller provides the time.
#pragma once

#include <cstdint>
#include <optional>

namespace overfly::net {

inline constexpr double kMinSpeed = 0.1;
inline constexpr double kMaxSpeed = 50.0;

class PlaybackCursor {
 public:
  /// A live run is followed live; a finished run starts paused at 0.
  explicit PlaybackCursor(bool running) : running_(running), playing_(running), live_(running) {}

  /// The recorded time span [0, end_ns], which grows while `running`. When a run ends, its live
  /// viewers are paused at its end.
  void set_extent(std::int64_t end_ns, bool running);
  /// Advances by the elapsed time times the speed, within the recorded span. A cursor that catches
  /// up with a live run becomes live; at the end of a finished run it stops or loops.
  /// @param now_ns  monotonic wall clock
  void advance(std::int64_t now_ns);

  /// Starts to play; from the beginning if a finished run is at its end.
  void play();
  void pause();
  /// Clamped to the recorded span; leaves live mode. Does not change whether it plays.
  void seek(std::int64_t t_ns);
  /// @pre speed in [kMinSpeed, kMaxSpeed]. Any speed other than 1 leaves live mode.
  void set_speed(double speed);
  void set_loop(bool loop) { loop_ = loop; }
  /// Follows the newest instant of a live run. @return false if it is not running
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
