#include "server/imagery/live/live_images.hpp"

namespace overfly::server {

Result<std::unique_ptr<LiveImages>> open_video_stream(const LiveAddress& address,
                                                      const std::atomic<bool>* /*cancel*/) {
  return Error{ErrorCode::kUnsupported,
               address.name +
                   ": this build reads no videos: install libavformat-dev, libavcodec-dev, "
                   "libavutil-dev and libswscale-dev, and build again"};
}

}  // namespace overfly::server
