// WebM files with one VP9 track.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/export/video/vp9_encoder.hpp"

namespace overfly::server {

/// Writes packets as they come, and the seek index at the end. The file appears whole at `finish`,
/// or not at all.
///
/// Method: Matroska (RFC 9559) in EBML (RFC 8794), within the limits of WebM; stamps in
/// milliseconds, one cluster per key image.
class WebmFile {
 public:
  /// Errors: kIo naming the file.
  static Result<WebmFile> create(const std::filesystem::path& file, int width_px, int height_px);
  ~WebmFile();  ///< removes the partial file if `finish` was not called
  WebmFile(WebmFile&&) noexcept;
  WebmFile& operator=(WebmFile&&) noexcept;

  /// @param packet  the first one must be a key image; stamps increase
  /// Errors: kIo.
  [[nodiscard]] Status add(const VideoPacket& packet);
  /// @param end_ms  end time of the last image
  /// Errors: kIo.
  [[nodiscard]] Status finish(std::int64_t end_ms);

 private:
  using Bytes = std::vector<std::uint8_t>;
  struct CuePoint {
    std::int64_t t_ms = 0;
    std::uint64_t cluster_position = 0;  ///< relative to the segment's first byte
  };
  WebmFile(std::FILE* stream, std::filesystem::path file, int width_px, int height_px);
  Status write(const Bytes& bytes);
  Status write_cluster();
  [[nodiscard]] Bytes head(std::int64_t end_ms,
                           std::uint64_t cues_position,
                           std::uint64_t segment_bytes) const;
  [[nodiscard]] Error failure() const;

  std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream_;
  std::filesystem::path file_;
  int width_px_;
  int height_px_;
  std::uint64_t written_ = 0;  ///< bytes of the segment's content so far
  std::int64_t cluster_ms_ = 0;
  Bytes cluster_;  ///< blocks of the open cluster
  std::vector<CuePoint> cues_;
};

}  // namespace overfly::server
