// Hands the newest image from the thread that receives it to the one that uses it.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

#include "core/camera/image.hpp"
#include "core/result.hpp"

namespace overfly::server {

/// Thread-safe.
class NewestImage {
 public:
  /// Replaces an image that was not taken.
  void put(Image image) {
    const std::lock_guard lock(mutex_);
    image_ = std::move(image);
    changed_.notify_all();
  }
  /// There will be no more images.
  void end(Error error) {
    const std::lock_guard lock(mutex_);
    if (!end_) end_ = std::move(error);
    changed_.notify_all();
  }
  /// Waits for an image. @return empty if none comes in time
  /// Errors: that of end().
  [[nodiscard]] Result<std::optional<Image>> take(std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, patience, [&] { return image_ || end_; });
    if (image_) return std::exchange(image_, std::nullopt);
    if (end_) return *end_;
    return std::optional<Image>();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Image> image_;
  std::optional<Error> end_;
};

}  // namespace overfly::server
