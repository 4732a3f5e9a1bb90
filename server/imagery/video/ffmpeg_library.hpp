// FFmpeg's libraries, loaded when the first video is opened: with them come 80 others, which would
// take a third of the time of each start of the program.
#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

#include "core/result.hpp"

namespace overfly::server {

/// Loads a library by the name of its file; it stays loaded. Errors: kUnsupported.
Result<void*> load_library(const char* name);
/// A function of a library. Errors: kUnsupported.
Result<void*> find_function(void* library, const char* name);

// X(library, function) for each function of FFmpeg that is called.
#define OVERFLY_FFMPEG_FUNCTIONS(X)         \
  X(avutil, av_dict_free)                   \
  X(avutil, av_dict_set)                    \
  X(avutil, av_frame_alloc)                 \
  X(avutil, av_frame_free)                  \
  X(avutil, av_free)                        \
  X(avutil, av_freep)                       \
  X(avutil, av_log_set_level)               \
  X(avutil, av_malloc)                      \
  X(avutil, av_opt_get)                     \
  X(avutil, av_rescale_q)                   \
  X(avutil, av_strdup)                      \
  X(avutil, av_strerror)                    \
  X(avcodec, av_packet_alloc)               \
  X(avcodec, av_packet_free)                \
  X(avcodec, av_packet_unref)               \
  X(avcodec, avcodec_alloc_context3)        \
  X(avcodec, avcodec_find_decoder)          \
  X(avcodec, avcodec_flush_buffers)         \
  X(avcodec, avcodec_free_context)          \
  X(avcodec, avcodec_get_name)              \
  X(avcodec, avcodec_open2)                 \
  X(avcodec, avcodec_parameters_to_context) \
  X(avcodec, avcodec_receive_frame)         \
  X(avcodec, avcodec_send_packet)           \
  X(avformat, av_find_input_format)         \
  X(avformat, av_read_frame)                \
  X(avformat, av_seek_frame)                \
  X(avformat, avformat_alloc_context)       \
  X(avformat, avformat_close_input)         \
  X(avformat, avformat_find_stream_info)    \
  X(avformat, avformat_open_input)          \
  X(avformat, avio_alloc_context)           \
  X(avformat, avio_context_free)            \
  X(swscale, sws_freeContext)               \
  X(swscale, sws_getCachedContext)          \
  X(swscale, sws_getCoefficients)           \
  X(swscale, sws_scale)                     \
  X(swscale, sws_setColorspaceDetails)

/// These functions, under their own names.
struct Ffmpeg {
#define OVERFLY_FFMPEG_POINTER(library, function) decltype(&::function) function = nullptr;
  OVERFLY_FFMPEG_FUNCTIONS(OVERFLY_FFMPEG_POINTER)
#undef OVERFLY_FFMPEG_POINTER
};

/// Loads the libraries at the first call and makes them silent. Callable on any thread.
/// Errors: kUnsupported naming the library that is missing.
Status load_ffmpeg();

/// @pre load_ffmpeg has succeeded
[[nodiscard]] const Ffmpeg& ffmpeg();

}  // namespace overfly::server
