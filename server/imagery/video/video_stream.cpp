// Live cameras by FFmpeg's libraries: RTSP, video over HTTP, V4L2 devices. Each address may use its
// own protocols only, and common formats and decoders.
#include <atomic>
#include <string>
#include <thread>
#include <utility>

#ifdef OVERFLY_V4L2
extern "C" {
#include <libavdevice/avdevice.h>
}
#endif

#include "core/barrier.hpp"
#include "core/cancel.hpp"
#include "server/imagery/live/live_images.hpp"
#include "server/imagery/live/newest_image.hpp"
#include "server/imagery/video/ffmpeg_handles.hpp"

namespace overfly::server {
namespace {

using Clock = std::chrono::steady_clock;

/// For the camera's answer, and between two frames.
constexpr std::chrono::seconds kCameraPatience{10};

struct Access {
  const char* protocols;
  const char* formats;
};

Access access_of(LiveKind kind) {
  if (kind == LiveKind::kRtsp) return {"rtsp,rtp,tcp,udp", "rtsp"};
  if (kind == LiveKind::kV4l2) return {"file", "video4linux2,v4l2"};
  return {"http,tcp", "mpjpeg,mjpeg,jpeg_pipe,mpegts,matroska,webm"};
}

/// Makes FFmpeg's V4L2 format known. Its library is loaded only here: with it come 70 others for
/// sound and windows.
Status register_v4l2() {
#ifdef OVERFLY_V4L2
  const Result<void*> library =
      load_library("libavdevice.so." AV_STRINGIFY(LIBAVDEVICE_VERSION_MAJOR));
  if (!library) return library.error();
  const Result<void*> function = find_function(*library, "avdevice_register_all");
  if (!function) return function.error();
  const auto register_all = reinterpret_cast<decltype(&avdevice_register_all)>(*function);
  register_all();
  return {};
#else
  return Error{ErrorCode::kUnsupported,
               "this build opens no V4L2 devices: install libavdevice-dev and build again"};
#endif
}

class Options {
 public:
  ~Options() { ffmpeg().av_dict_free(&values_); }
  Options() = default;
  Options(const Options&) = delete;
  Options& operator=(const Options&) = delete;
  void set(const char* name, const char* value) { ffmpeg().av_dict_set(&values_, name, value, 0); }
  AVDictionary** get() { return &values_; }

 private:
  AVDictionary* values_ = nullptr;
};

class VideoStream final : public LiveImages {
 public:
  VideoStream(const LiveAddress& address, const std::atomic<bool>* cancel)
      : address_(address), cancel_(cancel) {}
  ~VideoStream() override {
    stopping_ = true;
    if (thread_.joinable()) thread_.join();
  }

  Status open() {
    allow_time();
    if (Status status = connect(); !status) return status;
    Result<VideoDecoder> decoder = VideoDecoder::open(*stream_);
    if (!decoder) return decoder.error().in(address_.name);
    decoder_ = std::move(*decoder);
    thread_ = std::thread([this] { receive(); });
    return {};
  }

  [[nodiscard]] Result<std::optional<Image>> next(std::chrono::milliseconds patience) override {
    return newest_.take(patience);
  }

 private:
  void allow_time() { deadline_ = Clock::now() + kCameraPatience; }
  [[nodiscard]] bool interrupted() const {
    return stopping_ || is_cancelled(cancel_) || Clock::now() > deadline_.load();
  }
  [[nodiscard]] Error failed(const std::string& what, int code) const {
    if (is_cancelled(cancel_) || stopping_) {
      return {ErrorCode::kCancelled, address_.name + ": cancelled"};
    }
    const bool late = Clock::now() > deadline_.load();
    return {ErrorCode::kIo,
            address_.name + ": " + what + ": " +
                (late ? "no answer within " + std::to_string(kCameraPatience.count()) + " s"
                      : ffmpeg_text(code))};
  }

  Status connect() {
    const AVInputFormat* format = nullptr;
    if (address_.kind == LiveKind::kV4l2) {
      if (Status status = register_v4l2(); !status) return status.error().in(address_.name);
      format = ffmpeg().av_find_input_format("v4l2");
      if (format == nullptr) {
        return Error{ErrorCode::kUnsupported,
                     address_.name + ": FFmpeg's libraries here open no V4L2 devices"};
      }
    }
    AVFormatContext* context = ffmpeg().avformat_alloc_context();
    if (context == nullptr) {
      return Error{ErrorCode::kInternal, address_.name + ": out of memory"};
    }
    const Access access = access_of(address_.kind);
    context->interrupt_callback = {
        [](void* self) { return static_cast<VideoStream*>(self)->interrupted() ? 1 : 0; }, this};
    context->protocol_whitelist = ffmpeg().av_strdup(access.protocols);
    context->format_whitelist = ffmpeg().av_strdup(access.formats);
    context->codec_whitelist = ffmpeg().av_strdup(kVideoDecoders);
    context->max_streams = 16;
    context->flags |= AVFMT_FLAG_NOBUFFER;
    context->probesize = 1 << 20;
    context->max_analyze_duration = AV_TIME_BASE;
    Options options;
    // Its media come over the connection that was allowed, not from elsewhere.
    if (address_.kind == LiveKind::kRtsp) options.set("rtsp_transport", "tcp");
    // Frees the context if it fails.
    int code = ffmpeg().avformat_open_input(&context, address_.url.c_str(), format, options.get());
    if (code < 0) return failed("cannot be opened", code);
    format_.reset(context);
    if (Status status = check_redirection(); !status) return status;
    code = ffmpeg().avformat_find_stream_info(context, nullptr);
    if (code < 0) return failed("sends no video that is read", code);
    for (unsigned i = 0; i < context->nb_streams; ++i) {
      AVStream* const stream = context->streams[i];
      const bool video = stream->codecpar->codec_type == AVMEDIA_TYPE_VIDEO;
      if (video && stream_ == nullptr) {
        stream_ = stream;
      } else {
        stream->discard = AVDISCARD_ALL;
      }
    }
    if (stream_ != nullptr) return {};
    return Error{ErrorCode::kUnreadable, address_.name + ": sends no video"};
  }

  /// Where the video came from, as FFmpeg says it; empty if it does not say.
  [[nodiscard]] std::string location_of_answer() const {
    if (address_.kind == LiveKind::kRtsp) return format_->url;
    if (address_.kind == LiveKind::kV4l2) return "";
    std::uint8_t* text = nullptr;
    if (ffmpeg().av_opt_get(format_->pb, "location", AV_OPT_SEARCH_CHILDREN, &text) < 0) return "";
    std::string location = reinterpret_cast<const char*>(text);
    ffmpeg().av_free(text);
    return location;
  }

  /// A camera is no way to an address that the operator did not allow.
  [[nodiscard]] Status check_redirection() const {
    const std::string location = location_of_answer();
    if (location.empty() || location == address_.url) return {};
    return Error{ErrorCode::kIo,
                 address_.name + ": refers to another address; allow that one instead"};
  }

  void receive() {
    std::string why;
    (void)contained([&] { why = decode_until_end().message; },
                    [&](const char* what) { why = address_.name + ": " + what; });
    newest_.end({ErrorCode::kIo, why});
  }

  Error decode_until_end() {
    while (true) {
      allow_time();
      const int code = ffmpeg().av_read_frame(format_.get(), decoder_.packet.get());
      if (code < 0) return failed("the camera has ended", code);
      // A packet that cannot be decoded costs its frame only.
      if (decoder_.packet->stream_index == stream_->index) {
        (void)ffmpeg().avcodec_send_packet(decoder_.context.get(), decoder_.packet.get());
      }
      ffmpeg().av_packet_unref(decoder_.packet.get());
      while (ffmpeg().avcodec_receive_frame(decoder_.context.get(), decoder_.frame.get()) >= 0) {
        if ((decoder_.frame->flags & AV_FRAME_FLAG_CORRUPT) != 0) continue;
        Result<Image> image = converter_.convert(*decoder_.frame);
        if (!image) return image.error().in(address_.name);
        newest_.put(std::move(*image));
      }
    }
  }

  const LiveAddress address_;
  const std::atomic<bool>* cancel_;
  std::atomic<bool> stopping_{false};
  std::atomic<Clock::time_point> deadline_;
  std::unique_ptr<AVFormatContext, FormatCloser> format_;
  AVStream* stream_ = nullptr;  ///< of format_
  VideoDecoder decoder_;
  GreyConverter converter_;
  NewestImage newest_;
  std::thread thread_;
};

}  // namespace

Result<std::unique_ptr<LiveImages>> open_video_stream(const LiveAddress& address,
                                                      const std::atomic<bool>* cancel) {
  if (Status status = load_ffmpeg(); !status) return status.error().in(address.name);
  auto stream = std::make_unique<VideoStream>(address, cancel);
  if (Status status = stream->open(); !status) return status.error();
  return std::unique_ptr<LiveImages>(std::move(stream));
}

}  // namespace overfly::server
