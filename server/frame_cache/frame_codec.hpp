// Rendered pictures as bytes, without loss.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/result.hpp"
#include "renderer/renderer.hpp"

namespace overfly::server {

/// Compresses pictures fast rather than well, because reading one must cost much less than
/// rendering it: the difference of each sample to the one above it, then Huffman codes (zstd).
///
/// An 8-bit picture of textured ground takes a third to half of its size. Of radiances (32-bit
/// floats) only the upper halves are compressed, as the lower ones are random; they take two
/// thirds. Used by one thread.
class FrameCodec {
 public:
  FrameCodec();
  ~FrameCodec();
  FrameCodec(const FrameCodec&) = delete;
  FrameCodec& operator=(const FrameCodec&) = delete;

  /// The picture and its metadata, with a checksum; valid until the next call.
  [[nodiscard]] std::span<const std::uint8_t> encode(const renderer::CameraFrame& frame);
  /// @param request  what was drawn
  /// Errors: kUnreadable if the bytes are damaged, or are no picture of this size and format.
  [[nodiscard]] Result<renderer::CameraFrame> decode(std::span<const std::uint8_t> bytes,
                                                     const renderer::CameraRequest& request);

 private:
  struct Contexts;
  std::unique_ptr<Contexts> contexts_;
  /// Differences of 8-bit samples, or bytes of the differences of radiances.
  std::vector<std::uint8_t> third_, fourth_;
  std::vector<std::uint16_t> lower_;  ///< first and second bytes
  std::vector<std::uint8_t> encoded_;
};

/// Largest size of an encoded picture of `samples` samples, each of `sample_bytes`.
[[nodiscard]] std::size_t largest_encoded_bytes(std::size_t samples, std::size_t sample_bytes);

}  // namespace overfly::server
