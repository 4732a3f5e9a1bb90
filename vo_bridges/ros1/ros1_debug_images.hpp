// The debug images of an estimator, matched to frames.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>

#include "vo_bridges/ros1/ros1_types.hpp"

namespace overfly::ros1 {

/// Keeps the newest. May be used from any thread.
class DebugImages {
 public:
  /// An image that is drawn after the pose was published takes that long at most, on a busy
  /// machine.
  static constexpr std::chrono::milliseconds kPatience{1000};

  void deliver(const ImageMessage::ConstPtr& image);
  /// The image of the frame of that stamp, else the newest that was not taken yet (an estimator may
  /// stamp otherwise), else null.
  /// @param patience  for one that bears the stamp, while such are known to come
  [[nodiscard]] ImageMessage::ConstPtr take(std::int64_t stamp_ns,
                                            std::chrono::nanoseconds patience,
                                            const std::atomic<bool>* cancel = nullptr);
  /// Forgets what came for earlier frames.
  void forget();

 private:
  [[nodiscard]] bool has(std::int64_t stamp_ns) const;

  std::mutex mutex_;
  std::condition_variable came_;
  ImageMessage::ConstPtr newest_;
  bool comes_in_time_ = true;  ///< the first one is given a chance
};

}  // namespace overfly::ros1
