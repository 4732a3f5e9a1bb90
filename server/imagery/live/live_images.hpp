// Images of a live camera.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>

#include "core/camera/image.hpp"
#include "core/result.hpp"
#include "server/imagery/live/live_address.hpp"

namespace overfly::server {

/// Receives on threads of its own; next() is called by one thread.
class LiveImages {
 public:
  virtual ~LiveImages() = default;

  /// The newest image since the last call, as 8-bit grey; the ones between are dropped.
  /// @return empty if none comes in time
  /// Errors: kIo if the camera has ended; kUnreadable, kUnsupported for an image that is not read,
  /// after which others may come.
  [[nodiscard]] virtual Result<std::optional<Image>> next(std::chrono::milliseconds patience) = 0;
};

/// Connects to a camera. @param cancel  ends connecting and receiving; must outlive the images
/// Errors: kIo naming the camera, if it does not answer within 10 s; kUnreadable; kUnsupported for
/// a kind that this build lacks; kCancelled.
[[nodiscard]] Result<std::unique_ptr<LiveImages>> open_live_images(const LiveAddress& address,
                                                                   const std::atomic<bool>* cancel);

/// By FFmpeg: RTSP, HTTP, V4L2. As above.
[[nodiscard]] Result<std::unique_ptr<LiveImages>> open_video_stream(
    const LiveAddress& address, const std::atomic<bool>* cancel);

}  // namespace overfly::server
