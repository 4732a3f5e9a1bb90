#include "vo_bridges/ros1/ros1_debug_images.hpp"

#include <cstdlib>
#include <utility>

#include "core/cancellable_wait.hpp"
#include "vo_bridges/ros1/answer_patience.hpp"

namespace overfly::ros1 {

bool DebugImages::has(std::int64_t stamp_ns) const {
  if (!newest_) return false;
  const auto newest_ns = static_cast<std::int64_t>(newest_->header.stamp.toNSec());
  return std::abs(newest_ns - stamp_ns) <= kStampToleranceNs;
}

void DebugImages::deliver(const ImageMessage::ConstPtr& image) {
  const std::lock_guard lock(mutex_);
  newest_ = image;
  came_.notify_all();
}

ImageMessage::ConstPtr DebugImages::take(std::int64_t stamp_ns,
                                         std::chrono::nanoseconds patience,
                                         const std::atomic<bool>* cancel) {
  std::unique_lock lock(mutex_);
  if (comes_in_time_) {
    const auto end = std::chrono::steady_clock::now() + patience;
    comes_in_time_ = wait_unless_cancelled(cancel, end, [&](std::chrono::nanoseconds timeout) {
      return came_.wait_for(lock, timeout, [&] { return has(stamp_ns); });
    });
  }
  return std::exchange(newest_, nullptr);
}

}  // namespace overfly::ros1
