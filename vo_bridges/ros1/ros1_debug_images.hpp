// Matches an estimator's debug images to frames.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>

#include "middleware/ros1/types.hpp"

namespace overfly::ros1 {

/// Keeps the newest images. Thread-safe.
class DebugImages {
 public:
  /// Maximum delay of an image that is drawn after the pose was published, on a busy machine.
  static constexpr std::chrono::milliseconds kPatience{1000};

  void deliver(const ImageMessage::ConstPtr& image);
  /// The image with the frame's stamp; otherwise the newest that was not taken yet (an estimator
  /// may use other stamps); otherwise null.
  /// @param patience  how long to wait for a matching stamp, if such images usually arrive
  [[nodiscard]] ImageMessage::ConstPtr take(std::int64_t stamp_ns,
                                            std::chrono::nanoseconds patience,
                                            const std::atomic<bool>* cancel = nullptr);

 private:
  [[nodiscard]] bool has(std::int64_t stamp_ns) const;

  std::mutex mutex_;
  std::condition_variable came_;
  ImageMessage::ConstPtr newest_;
  bool comes_in_time_ = true;  ///< initially true, to wait for the first image
};

}  // namespace overfly::ros1
