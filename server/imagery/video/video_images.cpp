// Videos by FFmpeg's libraries. They are given bytes of one open file, and nothing else: no names,
// no protocols, and only demuxers and decoders of common camera formats.
#include "server/imagery/video_images.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "core/cancel.hpp"
#include "core/outside/file_text.hpp"
#include "core/time.hpp"
#include "server/imagery/video/ffmpeg_handles.hpp"

namespace overfly::server {
namespace {

constexpr std::size_t kMaxVideoFrames = 2'000'000;
constexpr int kIoBytes = 1 << 16;
constexpr std::int64_t kLatestNs = std::int64_t{1} << 60U;
constexpr const char* kFormats = "matroska,webm,mov,mp4,m4a,3gp,3g2,mj2,avi,mpegts";

struct IoCloser {
  void operator()(AVIOContext* context) const {
    ffmpeg().av_freep(&context->buffer);
    ffmpeg().avio_context_free(&context);
  }
};
/// The file as FFmpeg reads it.
struct OpenFile {
  ReadableFile file;
  std::int64_t size = 0;
  std::int64_t at = 0;

  static int read(void* self, std::uint8_t* bytes, int count) {
    auto& open = *static_cast<OpenFile*>(self);
    const auto got = open.file.read_some(static_cast<std::uint64_t>(open.at),
                                         {bytes, static_cast<std::size_t>(count)});
    if (!got) return AVERROR(EIO);
    if (*got == 0) return AVERROR_EOF;
    open.at += static_cast<std::int64_t>(*got);
    return static_cast<int>(*got);
  }
  static std::int64_t seek(void* self, std::int64_t offset, int whence) {
    auto& open = *static_cast<OpenFile*>(self);
    if (whence == AVSEEK_SIZE) return open.size;
    const int kind = whence & ~AVSEEK_FORCE;
    const std::int64_t base = kind == SEEK_CUR ? open.at : kind == SEEK_END ? open.size : 0;
    if (offset < -base || offset > kLatestNs - base) return AVERROR(EINVAL);
    open.at = base + offset;
    return open.at;
  }
};

/// Formats that refer to other files do not get them.
int refuse_file(AVFormatContext* /*context*/,
                AVIOContext** /*io*/,
                const char* /*url*/,
                int /*flags*/,
                AVDictionary** /*options*/) {
  return AVERROR(EPERM);
}

class VideoImages final : public ImageSource {
 public:
  VideoImages(OpenFile file, std::filesystem::path name)
      : file_(std::move(file)), name_(std::move(name)) {}

  Status open(const std::atomic<bool>* cancel) {
    cancel_ = cancel;
    if (Status status = open_container(); !status) return status;
    if (Status status = open_decoder(); !status) return status;
    const Status listed = list_frames();
    cancel_ = nullptr;  // it may end before this object
    return listed;
  }

  [[nodiscard]] const std::vector<std::int64_t>& stamps_ns() const override { return stamps_ns_; }
  [[nodiscard]] std::vector<std::string> warnings() const override { return warnings_; }

  [[nodiscard]] Result<Image> read(std::size_t i) override {
    const std::int64_t wanted_ns = stamps_ns_.at(i);
    if (!position_ns_ || *position_ns_ >= wanted_ns) {
      if (Status status = go_back(wanted_ns); !status) return status.error();
    }
    while (true) {
      const Result<bool> more = decode_next();
      if (!more) return more.error();
      if (!*more || *position_ns_ > wanted_ns) return damaged(i, "cannot be decoded");
      if (*position_ns_ == wanted_ns) break;
    }
    if ((decoder_.frame->flags & AV_FRAME_FLAG_CORRUPT) != 0 ||
        decoder_.frame->decode_error_flags != 0) {
      return damaged(i, "is damaged");
    }
    return grey(i);
  }

 private:
  [[nodiscard]] Error unreadable(const std::string& what) const {
    return {ErrorCode::kUnreadable, name_.string() + ": " + what};
  }
  [[nodiscard]] Error damaged(std::size_t i, const std::string& what) const {
    return unreadable("frame " + std::to_string(i) + " " + what);
  }

  Status open_container() {
    auto* buffer = static_cast<unsigned char*>(ffmpeg().av_malloc(kIoBytes));
    AVIOContext* io =
        buffer == nullptr
            ? nullptr
            : ffmpeg().avio_alloc_context(
                  buffer, kIoBytes, 0, &file_, &OpenFile::read, nullptr, &OpenFile::seek);
    if (io == nullptr) {
      ffmpeg().av_free(buffer);
      return Error{ErrorCode::kInternal, name_.string() + ": out of memory"};
    }
    io_.reset(io);
    AVFormatContext* context = ffmpeg().avformat_alloc_context();
    if (context == nullptr) return Error{ErrorCode::kInternal, name_.string() + ": out of memory"};
    context->pb = io;
    context->flags |= AVFMT_FLAG_CUSTOM_IO;
    context->io_open = refuse_file;
    context->interrupt_callback = {
        [](void* self) { return is_cancelled(static_cast<VideoImages*>(self)->cancel_) ? 1 : 0; },
        this};
    context->format_whitelist = ffmpeg().av_strdup(kFormats);
    context->codec_whitelist = ffmpeg().av_strdup(kVideoDecoders);
    context->protocol_whitelist = ffmpeg().av_strdup("none");
    context->max_streams = 16;
    // Frees the context if it fails.
    int code = ffmpeg().avformat_open_input(&context, nullptr, nullptr, nullptr);
    if (code < 0) return unreadable("is neither a log nor a video: " + ffmpeg_text(code));
    format_.reset(context);
    code = ffmpeg().avformat_find_stream_info(context, nullptr);
    if (code < 0) return unreadable("has no readable streams: " + ffmpeg_text(code));
    for (unsigned i = 0; i < context->nb_streams && stream_ == nullptr; ++i) {
      AVStream* const stream = context->streams[i];
      if (stream->codecpar->codec_type == AVMEDIA_TYPE_VIDEO)
        stream_ = stream;
      else
        stream->discard = AVDISCARD_ALL;
    }
    if (stream_ == nullptr) return unreadable("has no video stream");
    return {};
  }

  Status open_decoder() {
    Result<VideoDecoder> opened = VideoDecoder::open(*stream_);
    if (!opened) return opened.error().in(name_.string());
    decoder_ = std::move(*opened);
    return {};
  }

  /// The time of a time stamp; empty if there is none or it is not plausible.
  [[nodiscard]] std::optional<std::int64_t> time_ns(std::int64_t stamp) const {
    if (stamp == AV_NOPTS_VALUE) return std::nullopt;
    const std::int64_t t_ns =
        ffmpeg().av_rescale_q(stamp, stream_->time_base, AVRational{1, static_cast<int>(kNsPerS)});
    if (t_ns < 0 || t_ns > kLatestNs) return std::nullopt;
    return t_ns;
  }

  /// Lists the stamps of all frames, without decoding them.
  Status list_frames() {
    std::uint64_t without_time = 0;
    int code = 0;
    while ((code = ffmpeg().av_read_frame(format_.get(), decoder_.packet.get())) >= 0) {
      const bool own = decoder_.packet->stream_index == stream_->index;
      const std::optional<std::int64_t> t_ns = own ? time_ns(decoder_.packet->pts) : std::nullopt;
      if (t_ns) stamps_ns_.push_back(*t_ns);
      without_time += own && !t_ns ? 1 : 0;
      ffmpeg().av_packet_unref(decoder_.packet.get());
      if (stamps_ns_.size() > kMaxVideoFrames) {
        return unreadable("has more than " + std::to_string(kMaxVideoFrames) + " frames");
      }
    }
    if (is_cancelled(cancel_)) return Error{ErrorCode::kCancelled, "reading was cancelled"};
    if (code != AVERROR_EOF) warnings_.push_back("the video ends early: " + ffmpeg_text(code));
    if (without_time > 0) {
      warnings_.push_back(std::to_string(without_time) + " frames have no time and were left out");
    }
    std::sort(stamps_ns_.begin(), stamps_ns_.end());
    const auto end = std::unique(stamps_ns_.begin(), stamps_ns_.end());
    if (end != stamps_ns_.end()) {
      warnings_.push_back(std::to_string(stamps_ns_.end() - end) +
                          " frames have the time of another one and were left out");
    }
    stamps_ns_.erase(end, stamps_ns_.end());
    if (stamps_ns_.empty()) return unreadable("has no frames with a time");
    return {};
  }

  /// Moves to a key frame at or before a time.
  Status go_back(std::int64_t t_ns) {
    const std::int64_t stamp =
        ffmpeg().av_rescale_q(t_ns, AVRational{1, static_cast<int>(kNsPerS)}, stream_->time_base);
    const int code =
        ffmpeg().av_seek_frame(format_.get(), stream_->index, stamp, AVSEEK_FLAG_BACKWARD);
    if (code < 0)
      return unreadable("cannot be read from " + std::to_string(s_from_ns(t_ns)) + " s");
    ffmpeg().avcodec_flush_buffers(decoder_.context.get());
    ended_ = false;
    position_ns_.reset();
    return {};
  }

  /// Decodes the next frame that has a time. @return false at the end
  Result<bool> decode_next() {
    while (true) {
      const int code = ffmpeg().avcodec_receive_frame(decoder_.context.get(), decoder_.frame.get());
      if (code >= 0) {
        const auto t_ns = time_ns(decoder_.frame->best_effort_timestamp);
        if (!t_ns) continue;
        position_ns_ = t_ns;
        return true;
      }
      if (code == AVERROR_EOF || ended_) return false;
      if (code != AVERROR(EAGAIN)) return unreadable(ffmpeg_text(code));
      if (ffmpeg().av_read_frame(format_.get(), decoder_.packet.get()) < 0) {
        ended_ = true;
        (void)ffmpeg().avcodec_send_packet(decoder_.context.get(), nullptr);
        continue;
      }
      // A packet that cannot be decoded costs its frame only.
      if (decoder_.packet->stream_index == stream_->index) {
        (void)ffmpeg().avcodec_send_packet(decoder_.context.get(), decoder_.packet.get());
      }
      ffmpeg().av_packet_unref(decoder_.packet.get());
    }
  }

  Result<Image> grey(std::size_t i) {
    Result<Image> image = converter_.convert(*decoder_.frame);
    if (!image) return damaged(i, image.error().message);
    return image;
  }

  OpenFile file_;
  std::filesystem::path name_;
  const std::atomic<bool>* cancel_ = nullptr;
  std::unique_ptr<AVIOContext, IoCloser> io_;
  std::unique_ptr<AVFormatContext, FormatCloser> format_;  ///< closed before io_
  AVStream* stream_ = nullptr;                             ///< of format_
  VideoDecoder decoder_;
  GreyConverter converter_;
  std::vector<std::int64_t> stamps_ns_;
  std::vector<std::string> warnings_;
  std::optional<std::int64_t> position_ns_;  ///< of the last decoded frame
  bool ended_ = false;                       ///< the decoder has got all packets
};

}  // namespace

bool reads_videos() { return true; }

Result<std::unique_ptr<ImageSource>> open_video_images(const std::filesystem::path& file,
                                                       const std::atomic<bool>* cancel) {
  if (Status status = load_ffmpeg(); !status) return status.error().in(file.string());
  Result<ReadableFile> opened = ReadableFile::open(file);
  if (!opened) return opened.error();
  const Result<std::uint64_t> size = opened->size_bytes();
  if (!size) return size.error();
  auto video = std::make_unique<VideoImages>(
      OpenFile{std::move(opened).value(), static_cast<std::int64_t>(*size), 0}, file);
  if (Status status = video->open(cancel); !status) return status.error();
  return std::unique_ptr<ImageSource>(std::move(video));
}

}  // namespace overfly::server
