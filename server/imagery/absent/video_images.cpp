#include "server/imagery/video_images.hpp"

namespace overfly::server {

bool reads_videos() { return false; }

Result<std::unique_ptr<ImageSource>> open_video_images(const std::filesystem::path& file,
                                                       const std::atomic<bool>* /*cancel*/) {
  return Error{ErrorCode::kUnsupported,
               file.string() +
                   ": is no log, and this build reads no videos: install libavformat-dev, "
                   "libavcodec-dev, libavutil-dev and libswscale-dev, and build again"};
}

}  // namespace overfly::server
