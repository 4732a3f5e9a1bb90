// Schedules the pictures of one stream for one client: only the newest request counts, one picture
// at a time. Pure: the caller provides the time.
#pragma once

#include <cstdint>
#include <optional>

namespace overfly::net {

/// Identifies a picture: the instant, and the settings with which it is drawn.
struct PictureKey {
  std::int64_t frame = -1;
  std::uint64_t change = 0;  ///< increases with each seek, subscription and change of the view
  std::int64_t others = 0;   ///< sum of the times of other runs that it shows
  bool full = false;         ///< again with all details, after a reduced one that moved
  bool operator==(const PictureKey&) const = default;
};

class PictureSlot {
 public:
  explicit PictureSlot(double max_hz) : period_ns_(period_of(max_hz)) {}
  void set_max_hz(double max_hz) { period_ns_ = period_of(max_hz); }
  /// Upper limit of the rate, also for changed settings; empty = no limit.
  void set_limit_hz(std::optional<double> limit_hz) {
    least_period_ns_ = limit_hz ? period_of(*limit_hz) : 0;
  }

  /// Sets what the client should see now; only the latest call counts.
  void want(const PictureKey& key) { wanted_ = key; }
  /// The picture to draw now, which is then in flight. Empty while one is in flight, if the client
  /// already has this one, until the stream's period has passed, and while too many are unshown.
  [[nodiscard]] std::optional<PictureKey> take(std::int64_t now_ns);
  /// True if take() would give a picture.
  [[nodiscard]] bool due(std::int64_t now_ns) const;
  /// True if a picture is due, and waits because one before is still being sent, or because the
  /// client has not shown those before.
  [[nodiscard]] bool blocked(std::int64_t now_ns) const;
  /// The picture in flight is drawn and on its way.
  void sending() { sending_ = true; }
  /// The picture in flight has been sent or dropped.
  void done() { in_flight_ = sending_ = false; }
  /// Pictures that a client who reports what it shows may have got and not shown; 0 = it does not.
  void set_window(int pictures) { window_ = pictures; }
  void set_unshown(int pictures) { unshown_ = pictures; }
  [[nodiscard]] bool window_full() const { return window_ > 0 && unshown_ >= window_; }
  /// The picture in flight shows a newer frame than requested (as a live one does).
  void answered_with(std::int64_t frame) {
    if (taken_ && frame > taken_->frame) taken_->frame = frame;
  }

  [[nodiscard]] bool in_flight() const { return in_flight_; }
  /// True if a picture waits only for its time.
  [[nodiscard]] bool waiting() const { return !in_flight_ && wanted_ && wanted_ != taken_; }

 private:
  static std::int64_t period_of(double max_hz) { return static_cast<std::int64_t>(1e9 / max_hz); }

  /// When the wanted picture may be drawn at the earliest.
  [[nodiscard]] std::int64_t ready_ns() const;

  std::int64_t period_ns_;
  std::int64_t least_period_ns_ = 0;
  std::optional<PictureKey> wanted_;
  std::optional<PictureKey> taken_;
  std::int64_t due_ns_ = 0;
  std::int64_t taken_at_ns_ = 0;
  bool in_flight_ = false;
  bool sending_ = false;
  int window_ = 0;
  int unshown_ = 0;
};

}  // namespace overfly::net
