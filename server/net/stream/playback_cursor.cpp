#include "server/net/stream/playback_cursor.hpp"

#include <algorithm>
#include <cmath>

namespace overfly::net {

void PlaybackCursor::set_extent(std::int64_t end_ns, bool running) {
  end_ns_ = std::max<std::int64_t>(end_ns, 0);
  if (live_) t_ns_ = end_ns_;
  t_ns_ = std::clamp<std::int64_t>(t_ns_, 0, end_ns_);
  if (live_ && !running) {
    live_ = false;
    playing_ = false;
  }
  running_ = running;
}

void PlaybackCursor::advance(std::int64_t now_ns) {
  const std::int64_t elapsed_ns =
      last_now_ns_ ? std::max<std::int64_t>(now_ns - *last_now_ns_, 0) : 0;
  last_now_ns_ = now_ns;
  if (!playing_ || live_) return;
  t_ns_ += std::llround(static_cast<double>(elapsed_ns) * speed_);
  if (t_ns_ >= end_ns_) arrive_at_end(t_ns_ - end_ns_);
}

void PlaybackCursor::arrive_at_end(std::int64_t beyond_ns) {
  t_ns_ = end_ns_;
  if (running_) {
    live_ = true;
  } else if (loop_ && end_ns_ > 0) {
    t_ns_ = beyond_ns % (end_ns_ + 1);
  } else {
    playing_ = false;
  }
}

void PlaybackCursor::play() {
  if (!running_ && t_ns_ >= end_ns_) t_ns_ = 0;
  playing_ = true;
}

void PlaybackCursor::pause() {
  playing_ = false;
  live_ = false;
}

void PlaybackCursor::seek(std::int64_t t_ns) {
  live_ = false;
  t_ns_ = std::clamp<std::int64_t>(t_ns, 0, end_ns_);
}

void PlaybackCursor::set_speed(double speed) {
  speed_ = speed;
  if (speed != 1.0) live_ = false;
}

bool PlaybackCursor::go_live() {
  if (!running_) return false;
  live_ = true;
  playing_ = true;
  t_ns_ = end_ns_;
  return true;
}

}  // namespace overfly::net
