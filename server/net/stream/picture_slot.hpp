// When to draw the next picture of one stream for one client: keep the newest, one at a time.
// Pure: the caller gives the clock.
#pragma once

#include <cstdint>
#include <optional>

namespace overfly::net {

/// What makes a picture another one: the instant and how it is wanted.
struct PictureKey {
  std::int64_t frame = -1;
  std::uint64_t change = 0;  ///< grows with each seek, subscription and change of the view
  bool operator==(const PictureKey&) const = default;
};

class PictureSlot {
 public:
  explicit PictureSlot(double max_hz) : period_ns_(period_of(max_hz)) {}
  void set_max_hz(double max_hz) { period_ns_ = period_of(max_hz); }
  /// Nothing is drawn more often than this, not even a change; empty = no limit.
  void set_limit_hz(std::optional<double> limit_hz) {
    least_period_ns_ = limit_hz ? period_of(*limit_hz) : 0;
  }

  /// Says what the client should see now; only the newest wish counts.
  void want(const PictureKey& key) { wanted_ = key; }
  /// The picture to draw now, which is then in flight. Empty while one is in flight, when the
  /// client has this one, and before the stream's period is over.
  [[nodiscard]] std::optional<PictureKey> take(std::int64_t now_ns);
  /// What was in flight has been sent, or is not going to be.
  void done() { in_flight_ = false; }
  /// The picture in flight shows a newer frame than was asked for (a live one does).
  void answered_with(std::int64_t frame) {
    if (taken_ && frame > taken_->frame) taken_->frame = frame;
  }

  [[nodiscard]] bool in_flight() const { return in_flight_; }
  /// True when a picture waits for nothing but its time.
  [[nodiscard]] bool waiting() const { return !in_flight_ && wanted_ && wanted_ != taken_; }

 private:
  static std::int64_t period_of(double max_hz) { return static_cast<std::int64_t>(1e9 / max_hz); }

  std::int64_t period_ns_;
  std::int64_t least_period_ns_ = 0;
  std::optional<PictureKey> wanted_;
  std::optional<PictureKey> taken_;
  std::int64_t due_ns_ = 0;
  std::int64_t taken_at_ns_ = 0;
  bool in_flight_ = false;
};

}  // namespace overfly::net
