#include "flight/logs/ros/chunk_reader.hpp"

#include <algorithm>
#include <cstring>

#include "flight/logs/record_pass.hpp"

namespace overfly::flight::logs {

bool ChunkReader::make_room() {
  if (size_ < buffer_.size()) return true;
  if (size_ >= declared_) return false;
  // Grows with what is made, not with what is declared.
  buffer_.resize(std::min(declared_, std::max(2 * size_, ForwardReader::kBufferBytes)));
  return size_ < buffer_.size();
}

bool ChunkReader::take(std::span<const std::uint8_t> in, Decompressor* decompressor) {
  while (true) {
    const bool room = make_room();
    const std::size_t left = room ? std::min(buffer_.size(), declared_) - size_ : 0;
    std::uint8_t* const at = buffer_.data() + size_;
    if (decompressor == nullptr) {
      if (in.empty()) return true;
      const std::size_t count = std::min(in.size(), left);
      if (count == 0) return false;
      std::memcpy(at, in.data(), count);
      size_ += count;
      in = in.subspan(count);
      continue;
    }
    // Without room a step can still take the end of the stream.
    const Decompressor::Step step = decompressor->step(in, {at, left});
    size_ += step.made;
    in = in.subspan(step.used);
    if (step.failed) return false;
    if (step.ended) return in.empty();
    if (in.empty() && step.made < left) return true;
    if (step.used == 0 && step.made == 0) return in.empty();
  }
}

Result<ChunkReader::Chunk> ChunkReader::read(
    ForwardReader& file,
    std::uint64_t stored_bytes,
    ChunkCompression compression,
    std::uint64_t declared_bytes,
    const std::function<void(std::span<const std::uint8_t>)>& seen) {
  size_ = 0;
  declared_ = static_cast<std::size_t>(std::min(declared_bytes, kMaxBytes));
  Decompressor* decompressor = nullptr;
  if (compression != ChunkCompression::kNone) {
    std::unique_ptr<Decompressor>& kept = decompressors_[static_cast<std::size_t>(compression)];
    if (!kept) kept = create_decompressor(compression);
    kept->restart();
    decompressor = kept.get();
  }
  Chunk chunk;
  const Result<std::uint64_t> passed =
      pass_over(file, stored_bytes, [&](std::span<const std::uint8_t> piece) {
        if (seen) seen(piece);
        chunk.damaged = chunk.damaged || !take(piece, decompressor);
      });
  if (!passed) return passed.error();
  chunk.cut = *passed < stored_bytes;
  chunk.damaged = chunk.damaged || (!chunk.cut && size_ != declared_bytes);
  chunk.bytes = std::span(buffer_).first(size_);
  return chunk;
}

}  // namespace overfly::flight::logs
