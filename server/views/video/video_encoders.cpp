#include "server/views/video/video_encoders.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace overfly::server {
namespace {

/// An encoder that was not used for so long may be given to another stream.
constexpr std::int64_t kIdleNs = 2'000'000'000;

std::int64_t steady_now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace

void VideoEncoders::forget(std::uint64_t viewer) {
  std::erase_if(streams_, [&](const Stream& stream) { return stream.viewer == viewer; });
}

bool VideoEncoders::make_room(std::int64_t now_ns) {
  if (streams_.size() < kMost) return true;
  if (now_ns - streams_.back().used_ns < kIdleNs) return false;
  streams_.pop_back();
  return true;
}

Result<std::optional<LivePacket>> VideoEncoders::encode(const VideoChain& chain,
                                                        const Image& image,
                                                        int quality) {
  if (std::int64_t{image.width_px} * image.height_px > kMostPixels) {
    return std::optional<LivePacket>();
  }
  const std::int64_t now_ns = steady_now_ns();
  auto found = std::find_if(streams_.begin(), streams_.end(), [&](const Stream& other) {
    return other.viewer == chain.viewer && other.stream == chain.stream;
  });
  if (found != streams_.end() && (found->encoder.width_px() != image.width_px ||
                                  found->encoder.height_px() != image.height_px)) {
    streams_.erase(found);
    found = streams_.end();
  }
  const bool is_new = found == streams_.end();
  if (is_new) {
    if (!make_room(now_ns)) return std::optional<LivePacket>();
    auto encoder = LiveEncoder::open(image.width_px, image.height_px);
    if (!encoder) return encoder.error();
    streams_.push_front({chain.viewer, chain.stream, std::move(*encoder), 0, now_ns});
  } else {
    streams_.splice(streams_.begin(), streams_, found);
  }
  Stream& stream = streams_.front();
  const bool key = is_new || chain.key || stream.pictures != chain.pictures;
  auto packet = stream.encoder.encode(image, quality, key);
  if (!packet) {
    streams_.pop_front();
    return packet.error();
  }
  stream.pictures = chain.pictures + 1;
  stream.used_ns = now_ns;
  return std::optional(std::move(*packet));
}

}  // namespace overfly::server
