#include "server/net/stream/playback_clock.hpp"

#include <algorithm>
#include <cmath>

namespace overfly::net {
namespace {

bool contains(const PlaybackClock::Range& range, std::int64_t t_ns) {
  return range.begin_ns <= t_ns && t_ns <= range.end_ns;
}

}  // namespace

PlaybackClock::PlaybackClock(const Extent& extent) : extent_(extent), t_ns_(extent.begin_ns) {
  go_live();
}

PlaybackClock::Range PlaybackClock::bounds() const {
  const Range all{extent_.begin_ns, extent_.end_ns};
  if (!range_ || !contains(*range_, t_ns_)) return all;
  const Range part{std::max(range_->begin_ns, all.begin_ns), std::min(range_->end_ns, all.end_ns)};
  return part.begin_ns < part.end_ns ? part : all;
}

bool PlaybackClock::reaches_newest(const Range& within) const {
  return extent_.flying && within.end_ns >= extent_.newest_ns;
}

void PlaybackClock::set_extent(const Extent& extent) {
  extent_ = extent;
  extent_.end_ns = std::max(extent.begin_ns, extent.end_ns);
  if (live_) t_ns_ = extent.newest_ns;
  t_ns_ = std::clamp(t_ns_, extent_.begin_ns, extent_.end_ns);
  if (live_ && !extent.flying) pause();
}

void PlaybackClock::advance(std::int64_t now_ns) {
  const std::int64_t elapsed_ns =
      last_now_ns_ ? std::max<std::int64_t>(now_ns - *last_now_ns_, 0) : 0;
  last_now_ns_ = now_ns;
  if (!playing_ || live_) return;
  const Range within = bounds();
  const std::int64_t before_ns = t_ns_;
  const auto moved_ns = std::llround(static_cast<double>(elapsed_ns) * speed_);
  t_ns_ += moved_ns;
  if (speed_ > 0.0 && reaches_newest(within) && before_ns <= extent_.newest_ns &&
      t_ns_ >= extent_.newest_ns) {
    t_ns_ = extent_.newest_ns;
    if (speed_ >= 1.0) go_live();
    return;
  }
  if (t_ns_ < within.end_ns && speed_ > 0.0) return;
  if (t_ns_ > within.begin_ns && speed_ < 0.0) return;
  const std::int64_t span_ns = within.end_ns - within.begin_ns;
  if (loop_ && span_ns > 0) {
    t_ns_ = speed_ > 0.0 ? within.begin_ns + (t_ns_ - within.end_ns) % (span_ns + 1)
                         : within.end_ns - (within.begin_ns - t_ns_) % (span_ns + 1);
  } else {
    t_ns_ = speed_ > 0.0 ? within.end_ns : within.begin_ns;
    playing_ = false;
  }
}

void PlaybackClock::play() {
  const Range within = bounds();
  if (speed_ > 0.0 && t_ns_ >= within.end_ns && !reaches_newest(within)) t_ns_ = within.begin_ns;
  if (speed_ < 0.0 && t_ns_ <= within.begin_ns) t_ns_ = within.end_ns;
  playing_ = true;
}

void PlaybackClock::pause() {
  playing_ = false;
  live_ = false;
}

void PlaybackClock::seek(std::int64_t t_ns) {
  live_ = false;
  t_ns_ = std::clamp(t_ns, extent_.begin_ns, extent_.end_ns);
}

void PlaybackClock::set_speed(double speed) {
  speed_ = speed;
  if (speed != 1.0) live_ = false;
}

bool PlaybackClock::go_live() {
  if (!extent_.flying) return false;
  live_ = true;
  playing_ = true;
  speed_ = 1.0;
  t_ns_ = extent_.newest_ns;
  return true;
}

}  // namespace overfly::net
