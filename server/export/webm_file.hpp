// WebM files of one VP9 track.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/export/vp9_encoder.hpp"

namespace overfly::engine {

/// Writes packets as they come, and what makes the file seekable at the end. The file appears whole
/// at `finish`, or not at all.
///
/// Method: Matroska (RFC 9559) in EBML (RFC 8794), as far as WebM allows it; stamps in
/// milliseconds, a cluster from each key image on.
class WebmFile {
 public:
  /// Errors: kIo naming the file.
  static Result<WebmFile> create(const std::filesystem::path& file, int width_px, int height_px);
  ~WebmFile();  ///< without `finish`: removes what was written
  WebmFile(WebmFile&&) noexcept;
  WebmFile& operator=(WebmFile&&) noexcept;

  /// @param packet  the first one is a key image; stamps grow. Errors: kIo.
  [[nodiscard]] Status add(const VideoPacket& packet);
  /// @param end_ms  when the last image ends. Errors: kIo.
  [[nodiscard]] Status finish(std::int64_t end_ms);

 private:
  using Bytes = std::vector<std::uint8_t>;
  struct CuePoint {
    std::int64_t t_ms = 0;
    std::uint64_t cluster_position = 0;  ///< from the segment's first byte
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
  Bytes cluster_;  ///< blocks that wait for the cluster's end
  std::vector<CuePoint> cues_;
};

}  // namespace overfly::engine
