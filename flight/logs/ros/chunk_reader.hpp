// Reads the compressed chunks of MCAP files and ROS bags.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/outside/forward_reader.hpp"
#include "core/result.hpp"

namespace overfly::flight::logs {

enum class ChunkCompression { kNone, kLz4, kZstd, kBz2 };
/// "" and "none", "lz4" (frame format), "zstd", "bz2"; empty for other names.
[[nodiscard]] std::optional<ChunkCompression> chunk_compression_named(std::string_view name);

/// Decompresses one stream of data piece by piece.
class Decompressor {
 public:
  struct Step {
    std::size_t used = 0;  ///< input bytes
    std::size_t made = 0;  ///< output bytes
    bool failed = false;   ///< the data are damaged
    bool ended = false;    ///< what follows belongs to no stream
  };
  virtual ~Decompressor() = default;
  /// Prepares for the start of a stream.
  virtual void restart() = 0;
  virtual Step step(std::span<const std::uint8_t> in, std::span<std::uint8_t> out) = 0;
};
/// Memory: at most 128 MiB (zstd's window). @pre not kNone
[[nodiscard]] std::unique_ptr<Decompressor> create_decompressor(ChunkCompression compression);

/// Reads chunks one after the other into one buffer.
class ChunkReader {
 public:
  struct Chunk {
    std::span<const std::uint8_t> bytes;  ///< decompressed; valid until the next read
    bool cut = false;                     ///< the file ends within the chunk: `bytes` are its start
    bool damaged = false;                 ///< not compressed data, or not of the declared size
  };

  /// Reads the chunk at the file's position and moves behind it.
  /// @param stored_bytes    its size in the file
  /// @param declared_bytes  its size when decompressed, at most kMaxBytes; memory is only taken for
  ///                        what is really there
  /// @param seen            receives the stored bytes; may be empty
  /// Errors: kIo.
  [[nodiscard]] Result<Chunk> read(ForwardReader& file,
                                   std::uint64_t stored_bytes,
                                   ChunkCompression compression,
                                   std::uint64_t declared_bytes,
                                   const std::function<void(std::span<const std::uint8_t>)>& seen);

  /// Writers start a new chunk after some MiB; one image can make a chunk larger.
  static constexpr std::uint64_t kMaxBytes = std::uint64_t{128} << 20U;

 private:
  /// Takes a piece of the stored bytes. @return false: they are damaged
  bool take(std::span<const std::uint8_t> in, Decompressor* decompressor);
  bool make_room();

  std::vector<std::uint8_t> buffer_;
  std::size_t size_ = 0;      ///< bytes in buffer_ that belong to the chunk
  std::size_t declared_ = 0;  ///< of the chunk
  std::unique_ptr<Decompressor> decompressors_[4];
};

}  // namespace overfly::flight::logs
