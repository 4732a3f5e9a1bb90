#include "server/export/video/webm_file.hpp"

#include <bit>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>

#include "server/files/build_info.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

// Element identifiers (RFC 8794, section 11.2; RFC 9559, section 5).
constexpr std::uint32_t kEbml = 0x1A45DFA3;
constexpr std::uint32_t kSegment = 0x18538067;
constexpr std::uint32_t kSeekHead = 0x114D9B74;
constexpr std::uint32_t kInfo = 0x1549A966;
constexpr std::uint32_t kTracks = 0x1654AE6B;
constexpr std::uint32_t kCluster = 0x1F43B675;
constexpr std::uint32_t kCues = 0x1C53BB6B;

/// Block stamps are 16-bit offsets from their cluster's stamp.
constexpr std::int64_t kLongestClusterMs = 30'000;

void put_big_endian(std::uint64_t value, int bytes, Bytes& out) {
  for (int i = bytes - 1; i >= 0; --i) {
    out.push_back(static_cast<std::uint8_t>(value >> (8U * static_cast<unsigned>(i))));
  }
}

void put_id(std::uint32_t id, Bytes& out) {
  const int bytes = id > 0xFFFFFF ? 4 : id > 0xFFFF ? 3 : id > 0xFF ? 2 : 1;
  put_big_endian(id, bytes, out);
}

/// Size of an element's content in eight bytes (RFC 8794, section 4), so that the head has constant
/// length.
void put_size(std::uint64_t size, Bytes& out) { put_big_endian((1ULL << 56U) | size, 8, out); }

void put_element(std::uint32_t id, const Bytes& content, Bytes& out) {
  put_id(id, out);
  put_size(content.size(), out);
  out.insert(out.end(), content.begin(), content.end());
}

void put_uint(std::uint32_t id, std::uint64_t value, Bytes& out) {
  Bytes content;
  put_big_endian(value, 8, content);
  put_element(id, content, out);
}

void put_double(std::uint32_t id, double value, Bytes& out) {
  put_uint(id, std::bit_cast<std::uint64_t>(value), out);
}

void put_text(std::uint32_t id, std::string_view text, Bytes& out) {
  put_element(id, Bytes(text.begin(), text.end()), out);
}

Bytes ebml_header() {
  Bytes content;
  put_uint(0x4286, 1, content);  // EBMLVersion
  put_uint(0x42F7, 1, content);  // EBMLReadVersion
  put_uint(0x42F2, 4, content);  // EBMLMaxIDLength
  put_uint(0x42F3, 8, content);  // EBMLMaxSizeLength
  put_text(0x4282, "webm", content);
  put_uint(0x4287, 4, content);  // DocTypeVersion
  put_uint(0x4285, 2, content);  // DocTypeReadVersion
  Bytes out;
  put_element(kEbml, content, out);
  return out;
}

void put_seek(std::uint32_t id, std::uint64_t position, Bytes& out) {
  Bytes id_bytes;
  put_id(id, id_bytes);
  Bytes content;
  put_element(0x53AB, id_bytes, content);  // SeekID
  put_uint(0x53AC, position, content);     // SeekPosition
  put_element(0x4DBB, content, out);
}

Bytes info_element(std::int64_t end_ms) {
  constexpr std::uint64_t kNsPerTick = 1'000'000;
  Bytes content;
  put_uint(0x2AD7B1, kNsPerTick, content);  // TimestampScale
  put_double(0x4489, static_cast<double>(end_ms), content);
  put_text(0x4D80, "overfly", content);               // MuxingApp
  put_text(0x5741, "overfly " + version(), content);  // WritingApp
  Bytes out;
  put_element(kInfo, content, out);
  return out;
}

Bytes tracks_element(int width_px, int height_px) {
  Bytes colour;
  for (const std::uint32_t id : {0x55B1U, 0x55B9U, 0x55BAU, 0x55BBU}) {
    put_uint(id, 1, colour);  // BT.709 matrix, narrow range, BT.709 transfer and primaries
  }
  Bytes video;
  put_uint(0xB0, static_cast<std::uint64_t>(width_px), video);
  put_uint(0xBA, static_cast<std::uint64_t>(height_px), video);
  put_element(0x55B0, colour, video);
  Bytes entry;
  put_uint(0xD7, 1, entry);    // TrackNumber
  put_uint(0x73C5, 1, entry);  // TrackUID
  put_uint(0x83, 1, entry);    // TrackType: video
  put_uint(0x9C, 0, entry);    // FlagLacing
  put_text(0x86, "V_VP9", entry);
  put_element(0xE0, video, entry);
  Bytes list;
  put_element(0xAE, entry, list);
  Bytes out;
  put_element(kTracks, list, out);
  return out;
}

fs::path part_of(fs::path file) { return file += ".part"; }

}  // namespace

WebmFile::WebmFile(std::FILE* stream, fs::path file, int width_px, int height_px)
    : stream_(stream, std::fclose),
      file_(std::move(file)),
      width_px_(width_px),
      height_px_(height_px) {}

WebmFile::WebmFile(WebmFile&&) noexcept = default;
WebmFile& WebmFile::operator=(WebmFile&&) noexcept = default;

WebmFile::~WebmFile() {
  if (!stream_) return;
  stream_.reset();
  std::error_code ignored;
  fs::remove(part_of(file_), ignored);
}

Error WebmFile::failure() const {
  return {ErrorCode::kIo, file_.string() + ": cannot be written: " + std::strerror(errno)};
}

/// Everything before the first cluster; its length does not depend on the values.
WebmFile::Bytes WebmFile::head(std::int64_t end_ms,
                               std::uint64_t cues_position,
                               std::uint64_t segment_bytes) const {
  const Bytes info = info_element(end_ms);
  const Bytes tracks = tracks_element(width_px_, height_px_);
  Bytes seeks;
  // Later positions need its length, which does not depend on them.
  for (int pass = 0; pass < 2; ++pass) {
    const std::uint64_t behind = 12 + seeks.size();
    seeks.clear();
    put_seek(kInfo, behind, seeks);
    put_seek(kTracks, behind + info.size(), seeks);
    put_seek(kCues, cues_position, seeks);
  }
  Bytes out = ebml_header();
  put_id(kSegment, out);
  put_size(segment_bytes, out);
  put_element(kSeekHead, seeks, out);
  out.insert(out.end(), info.begin(), info.end());
  out.insert(out.end(), tracks.begin(), tracks.end());
  return out;
}

Result<WebmFile> WebmFile::create(const fs::path& file, int width_px, int height_px) {
  std::FILE* stream = std::fopen(part_of(file).c_str(), "wb");
  if (stream == nullptr) {
    return Error{ErrorCode::kIo, file.string() + ": cannot be written: " + std::strerror(errno)};
  }
  WebmFile webm(stream, file, width_px, height_px);
  const Bytes head = webm.head(0, 0, 0);
  if (Status status = webm.write(head); !status) return status.error();
  constexpr std::uint64_t kSegmentHead = 12;
  webm.written_ = head.size() - ebml_header().size() - kSegmentHead;
  return webm;
}

Status WebmFile::write(const Bytes& bytes) {
  written_ += bytes.size();
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_.get()) != bytes.size()) return failure();
  return {};
}

Status WebmFile::write_cluster() {
  if (cluster_.empty()) return {};
  Bytes content;
  put_uint(0xE7, static_cast<std::uint64_t>(cluster_ms_), content);
  content.insert(content.end(), cluster_.begin(), cluster_.end());
  cluster_.clear();
  Bytes out;
  put_element(kCluster, content, out);
  return write(out);
}

Status WebmFile::add(const VideoPacket& packet) {
  if (cluster_.empty() || packet.key || packet.t_ms - cluster_ms_ > kLongestClusterMs) {
    if (Status status = write_cluster(); !status) return status;
    cluster_ms_ = packet.t_ms;
    if (packet.key) cues_.push_back({packet.t_ms, written_});
  }
  Bytes block;
  block.push_back(0x81);  // track 1
  put_big_endian(static_cast<std::uint64_t>(packet.t_ms - cluster_ms_), 2, block);
  block.push_back(packet.key ? 0x80 : 0x00);
  block.insert(block.end(), packet.bytes.begin(), packet.bytes.end());
  put_element(0xA3, block, cluster_);  // SimpleBlock
  return {};
}

Status WebmFile::finish(std::int64_t end_ms) {
  if (Status status = write_cluster(); !status) return status;
  const std::uint64_t cues_position = written_;
  Bytes content;
  for (const CuePoint& cue : cues_) {
    Bytes positions;
    put_uint(0xF7, 1, positions);                     // CueTrack
    put_uint(0xF1, cue.cluster_position, positions);  // CueClusterPosition
    Bytes point;
    put_uint(0xB3, static_cast<std::uint64_t>(cue.t_ms), point);
    put_element(0xB7, positions, point);
    put_element(0xBB, point, content);
  }
  Bytes cues;
  put_element(kCues, content, cues);
  if (Status status = write(cues); !status) return status;
  const Bytes head_now = head(end_ms, cues_position, written_);
  if (std::fseek(stream_.get(), 0, SEEK_SET) != 0) return failure();
  if (Status status = write(head_now); !status) return status;
  std::error_code failed;
  if (std::fclose(stream_.release()) != 0) {
    const Error error = failure();
    fs::remove(part_of(file_), failed);
    return error;
  }
  fs::rename(part_of(file_), file_, failed);
  if (failed) {
    std::error_code ignored;
    fs::remove(part_of(file_), ignored);
    return Error{ErrorCode::kIo, file_.string() + ": cannot be written: " + failed.message()};
  }
  return {};
}

}  // namespace overfly::server
