// What the users of FFmpeg's libraries share: owners of its objects, its error texts, and decoded
// frames as grey images. load_ffmpeg must have succeeded.
#pragma once

#include <memory>
#include <string>

#include "core/camera/image.hpp"
#include "core/result.hpp"
#include "server/imagery/video/ffmpeg_library.hpp"

namespace overfly::server {

struct FormatCloser {
  void operator()(AVFormatContext* context) const { ffmpeg().avformat_close_input(&context); }
};
struct CodecCloser {
  void operator()(AVCodecContext* context) const { ffmpeg().avcodec_free_context(&context); }
};
struct PacketCloser {
  void operator()(AVPacket* packet) const { ffmpeg().av_packet_free(&packet); }
};
struct FrameCloser {
  void operator()(AVFrame* frame) const { ffmpeg().av_frame_free(&frame); }
};
struct ScalerCloser {
  void operator()(SwsContext* scaler) const { ffmpeg().sws_freeContext(scaler); }
};

inline constexpr int kMostFrameSidePx = 8192;
/// Decoders of common camera formats; no others are opened.
inline constexpr const char* kVideoDecoders =
    "vp8,vp9,libvpx,libvpx-vp9,av1,libdav1d,libaom-av1,h264,hevc,mpeg4,mpeg2video,mjpeg,ffv1,"
    "rawvideo,prores,huffyuv,utvideo";

[[nodiscard]] std::string ffmpeg_text(int code);

/// A decoder with what it works on.
struct VideoDecoder {
  std::unique_ptr<AVCodecContext, CodecCloser> context;
  std::unique_ptr<AVPacket, PacketCloser> packet;
  std::unique_ptr<AVFrame, FrameCloser> frame;

  /// Errors: kUnreadable; kUnsupported without such a decoder; kInternal.
  static Result<VideoDecoder> open(const AVStream& stream);
};

/// Converts decoded frames to 8-bit grey in full range.
class GreyConverter {
 public:
  /// Errors: kUnreadable for an impossible size, or a pixel format that is not read.
  [[nodiscard]] Result<Image> convert(const AVFrame& frame);

 private:
  std::unique_ptr<SwsContext, ScalerCloser> scaler_;
};

}  // namespace overfly::server
