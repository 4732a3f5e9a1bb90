// The encoders of the picture streams that are sent as video.
#pragma once

#include <cstdint>
#include <list>
#include <optional>

#include "core/camera/image.hpp"
#include "core/result.hpp"
#include "server/views/picture_request.hpp"
#include "server/views/video/live_encoder.hpp"

namespace overfly::server {

/// One for each stream; each holds the picture that its client has. Used on one thread.
class VideoEncoders {
 public:
  /// Each needs about ten times the bytes of a picture.
  static constexpr std::size_t kMost = 6;

  /// The picture as the next one of the chain: a key picture if the chain asks for one, if the
  /// client does not have the encoder's last picture, or if the size has changed. Empty if all
  /// encoders are in use.
  /// Errors: as LiveEncoder.
  [[nodiscard]] Result<std::optional<LivePacket>> encode(const VideoChain& chain,
                                                         const Image& image,
                                                         int quality);

 private:
  struct Stream {
    std::uint64_t viewer = 0;
    std::uint32_t stream = 0;
    LiveEncoder encoder;
    std::uint64_t pictures = 0;  ///< of the chain, that the encoder has made
    std::int64_t used_ns = 0;    ///< when it was used last
  };
  /// Makes room for another one. @return false if all are in use
  bool make_room(std::int64_t now_ns);

  std::list<Stream> streams_;  ///< most recently used first
};

}  // namespace overfly::server
