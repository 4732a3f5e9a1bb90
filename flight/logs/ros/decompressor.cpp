#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>

#include "flight/logs/ros/chunk_reader.hpp"

namespace overfly::flight::logs {
namespace {

class Lz4Decompressor final : public Decompressor {
 public:
  Lz4Decompressor() {
    // Fails only without memory; context_ is then null.
    if (LZ4F_isError(LZ4F_createDecompressionContext(&context_, LZ4F_VERSION)) != 0U) {
      context_ = nullptr;
    }
  }
  ~Lz4Decompressor() override { LZ4F_freeDecompressionContext(context_); }
  Lz4Decompressor(const Lz4Decompressor&) = delete;
  Lz4Decompressor& operator=(const Lz4Decompressor&) = delete;

  void restart() override {
    if (context_ != nullptr) LZ4F_resetDecompressionContext(context_);
  }
  Step step(std::span<const std::uint8_t> in, std::span<std::uint8_t> out) override {
    if (context_ == nullptr) return {0, 0, true, false};
    std::size_t used = in.size();
    std::size_t made = out.size();
    const std::size_t result =
        LZ4F_decompress(context_, out.data(), &made, in.data(), &used, nullptr);
    return {used, made, LZ4F_isError(result) != 0U, false};
  }

 private:
  LZ4F_dctx* context_ = nullptr;
};

class ZstdDecompressor final : public Decompressor {
 public:
  ZstdDecompressor() : stream_(ZSTD_createDStream()) {}
  ~ZstdDecompressor() override { ZSTD_freeDStream(stream_); }
  ZstdDecompressor(const ZstdDecompressor&) = delete;
  ZstdDecompressor& operator=(const ZstdDecompressor&) = delete;

  void restart() override {
    if (stream_ != nullptr) ZSTD_initDStream(stream_);
  }
  Step step(std::span<const std::uint8_t> in, std::span<std::uint8_t> out) override {
    if (stream_ == nullptr) return {0, 0, true, false};
    ZSTD_inBuffer input{in.data(), in.size(), 0};
    ZSTD_outBuffer output{out.data(), out.size(), 0};
    const std::size_t result = ZSTD_decompressStream(stream_, &output, &input);
    return {input.pos, output.pos, ZSTD_isError(result) != 0U, false};
  }

 private:
  ZSTD_DStream* stream_;
};

class Bz2Decompressor final : public Decompressor {
 public:
  Bz2Decompressor() = default;
  ~Bz2Decompressor() override { end(); }
  Bz2Decompressor(const Bz2Decompressor&) = delete;
  Bz2Decompressor& operator=(const Bz2Decompressor&) = delete;

  void restart() override {
    end();
    stream_ = {};
    ready_ = BZ2_bzDecompressInit(&stream_, 0, 0) == BZ_OK;
  }
  Step step(std::span<const std::uint8_t> in, std::span<std::uint8_t> out) override {
    if (!ready_) return {0, 0, true, false};
    const std::size_t in_size = std::min(in.size(), kMostBytes);
    const std::size_t out_size = std::min(out.size(), kMostBytes);
    // The library's interface lacks const; it does not write to its input.
    stream_.next_in = const_cast<char*>(reinterpret_cast<const char*>(in.data()));
    stream_.avail_in = static_cast<unsigned>(in_size);
    stream_.next_out = reinterpret_cast<char*>(out.data());
    stream_.avail_out = static_cast<unsigned>(out_size);
    const int result = BZ2_bzDecompress(&stream_);
    return {in_size - stream_.avail_in,
            out_size - stream_.avail_out,
            result != BZ_OK && result != BZ_STREAM_END,
            result == BZ_STREAM_END};
  }

 private:
  static constexpr std::size_t kMostBytes = std::size_t{1} << 30U;
  void end() {
    if (ready_) BZ2_bzDecompressEnd(&stream_);
    ready_ = false;
  }

  bz_stream stream_{};
  bool ready_ = false;
};

}  // namespace

std::optional<ChunkCompression> chunk_compression_named(std::string_view name) {
  if (name.empty() || name == "none") return ChunkCompression::kNone;
  if (name == "lz4") return ChunkCompression::kLz4;
  if (name == "zstd") return ChunkCompression::kZstd;
  if (name == "bz2") return ChunkCompression::kBz2;
  return std::nullopt;
}

std::unique_ptr<Decompressor> create_decompressor(ChunkCompression compression) {
  switch (compression) {
    case ChunkCompression::kLz4:
      return std::make_unique<Lz4Decompressor>();
    case ChunkCompression::kZstd:
      return std::make_unique<ZstdDecompressor>();
    default:
      return std::make_unique<Bz2Decompressor>();
  }
}

}  // namespace overfly::flight::logs
