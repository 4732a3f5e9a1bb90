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
  static constexpr std::size_t kMost = 6;
  /// Larger pictures take too long, and their encoders too much memory: about ten times the bytes
  /// of a picture.
  static constexpr std::int64_t kMostPixels = std::int64_t{1920} * 1440;

  /// The picture as the next one of the chain: a key picture if the chain asks for one, if the
  /// client does not have the encoder's last picture, or if the size has changed. Empty if all
  /// encoders are in use, and beyond kMostPixels.
  /// Errors: as LiveEncoder.
  [[nodiscard]] Result<std::optional<LivePacket>> encode(const VideoChain& chain,
                                                         const Image& image,
                                                         int quality);
  /// Frees the encoders of a viewer that has gone.
  void forget(std::uint64_t viewer);
  [[nodiscard]] std::size_t size() const { return streams_.size(); }

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
