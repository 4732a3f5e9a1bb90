#include "server/imagery/video/ffmpeg_handles.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace overfly::server {
namespace {

Error unreadable_frame(const std::string& what) { return {ErrorCode::kUnreadable, what}; }

bool fits(int width, int height) {
  return width > 0 && height > 0 && width <= kMostFrameSidePx && height <= kMostFrameSidePx;
}

}  // namespace

std::string ffmpeg_text(int code) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  ffmpeg().av_strerror(code, text.data(), text.size());
  return text.data();
}

Result<VideoDecoder> VideoDecoder::open(const AVStream& stream) {
  const AVCodecParameters& parameters = *stream.codecpar;
  if (!fits(parameters.width, parameters.height)) {
    return unreadable_frame("frames of " + std::to_string(parameters.width) + " x " +
                            std::to_string(parameters.height) + " px: must be at most " +
                            std::to_string(kMostFrameSidePx) + " px wide and high");
  }
  const AVCodec* const codec = ffmpeg().avcodec_find_decoder(parameters.codec_id);
  if (codec == nullptr) {
    return Error{ErrorCode::kUnsupported,
                 std::string("no decoder for ") + ffmpeg().avcodec_get_name(parameters.codec_id)};
  }
  VideoDecoder decoder;
  decoder.context.reset(ffmpeg().avcodec_alloc_context3(codec));
  decoder.packet.reset(ffmpeg().av_packet_alloc());
  decoder.frame.reset(ffmpeg().av_frame_alloc());
  if (!decoder.context || !decoder.packet || !decoder.frame) {
    return Error{ErrorCode::kInternal, "out of memory"};
  }
  AVCodecContext& context = *decoder.context;
  int code = ffmpeg().avcodec_parameters_to_context(&context, &parameters);
  context.max_pixels = std::int64_t{kMostFrameSidePx} * kMostFrameSidePx;
  context.thread_count = 1;
  context.pkt_timebase = stream.time_base;
  context.codec_whitelist = ffmpeg().av_strdup(kVideoDecoders);
  if (code >= 0) code = ffmpeg().avcodec_open2(&context, codec, nullptr);
  if (code < 0) {
    return unreadable_frame("decoder " + std::string(codec->name) + ": " + ffmpeg_text(code));
  }
  return decoder;
}

Result<Image> GreyConverter::convert(const AVFrame& frame) {
  const int width = frame.width;
  const int height = frame.height;
  if (!fits(width, height)) return unreadable_frame("has an impossible size");
  const auto format = static_cast<AVPixelFormat>(frame.format);
  scaler_.reset(ffmpeg().sws_getCachedContext(scaler_.release(),
                                              width,
                                              height,
                                              format,
                                              width,
                                              height,
                                              AV_PIX_FMT_GRAY8,
                                              SWS_BILINEAR | SWS_ACCURATE_RND,
                                              nullptr,
                                              nullptr,
                                              nullptr));
  if (!scaler_) return unreadable_frame("has a pixel format that is not read");
  const bool full = frame.color_range == AVCOL_RANGE_JPEG;
  const int* const matrix = ffmpeg().sws_getCoefficients(SWS_CS_ITU709);
  (void)ffmpeg().sws_setColorspaceDetails(
      scaler_.get(), matrix, full ? 1 : 0, matrix, 1, 0, 1 << 16, 1 << 16);
  // Rows of FFmpeg's own alignment: its fast paths write whole vectors.
  const int row_bytes = (width + 63) / 64 * 64;
  std::vector<std::uint8_t> rows(static_cast<std::size_t>(row_bytes) * height + 64);
  std::uint8_t* const planes[4] = {rows.data(), nullptr, nullptr, nullptr};
  const int steps[4] = {row_bytes, 0, 0, 0};
  if (ffmpeg().sws_scale(scaler_.get(), frame.data, frame.linesize, 0, height, planes, steps) !=
      height) {
    return unreadable_frame("cannot be converted");
  }
  Image image(width, height, 1);
  for (int y = 0; y < height; ++y) {
    std::copy_n(rows.data() + static_cast<std::size_t>(row_bytes) * y, width, &image.at(0, y));
  }
  return image;
}

}  // namespace overfly::server
