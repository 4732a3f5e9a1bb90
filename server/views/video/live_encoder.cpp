#include "server/views/video/live_encoder.hpp"

#include <vpx/vp8cx.h>
#include <vpx/vpx_encoder.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace overfly::server {
namespace {

/// 13 ms for 1280 x 960 where a JPEG needs 3 ms. Slower speeds save few bytes; faster ones save
/// little time and cost many (docs/PERFORMANCE.md, "Pictures as video").
constexpr int kSpeed = -8;
constexpr int kMostSidePx = 16383;
constexpr unsigned kPeriodMs = 32;

Status check_side(const char* field, int value) {
  if (value >= 1 && value <= kMostSidePx) return {};
  return Error{
      ErrorCode::kInvalidArgument,
      std::string("picture.") + field + " = " + std::to_string(value) + ": must be in [1, 16383]"};
}

std::uint8_t sample_of(int scaled) {
  return static_cast<std::uint8_t>(std::clamp((scaled + 32768) >> 16, 0, 255));
}

/// Luma and chroma planes, chroma at half resolution.
struct Planes {
  int chroma_width_px = 0;
  int chroma_height_px = 0;
  std::vector<std::uint8_t> y, u, v;

  Planes(int width_px, int height_px)
      : chroma_width_px((width_px + 1) / 2),
        chroma_height_px((height_px + 1) / 2),
        u(static_cast<std::size_t>(chroma_width_px) * chroma_height_px, 128),
        v(u.size(), 128) {}
};

/// JFIF's conversion, in units of 1/65536.
void convert(const Image& rgb, Planes* planes) {
  planes->y.resize(static_cast<std::size_t>(rgb.width_px) * rgb.height_px);
  const std::uint8_t* p = rgb.data.data();
  for (std::uint8_t& luma : planes->y) {
    luma = sample_of(19595 * p[0] + 38470 * p[1] + 7471 * p[2]);
    p += 3;
  }
  std::size_t at = 0;
  for (int y = 0; y < planes->chroma_height_px; ++y) {
    const int below = std::min(2 * y + 1, rgb.height_px - 1);
    for (int x = 0; x < planes->chroma_width_px; ++x, ++at) {
      const int right = std::min(2 * x + 1, rgb.width_px - 1);
      std::array<int, 3> sum{};
      for (int c = 0; c < 3; ++c) {
        sum[static_cast<std::size_t>(c)] = rgb.at(2 * x, 2 * y, c) + rgb.at(right, 2 * y, c) +
                                           rgb.at(2 * x, below, c) + rgb.at(right, below, c);
      }
      planes->u[at] =
          sample_of(128 * 65536 + (-11056 * sum[0] - 21712 * sum[1] + 32768 * sum[2]) / 4);
      planes->v[at] =
          sample_of(128 * 65536 + (32768 * sum[0] - 27440 * sum[1] - 5328 * sum[2]) / 4);
    }
  }
}

}  // namespace

int quantiser_like_jpeg(int quality) {
  // Measured on flights over a photograph and over the built-in world (docs/PERFORMANCE.md).
  constexpr std::array<std::pair<int, int>, 8> kTable = {
      {{1, 63}, {30, 42}, {45, 31}, {60, 22}, {75, 14}, {85, 10}, {90, 8}, {100, 2}}};
  const int bounded = std::clamp(quality, kTable.front().first, kTable.back().first);
  for (std::size_t i = 1; i < kTable.size(); ++i) {
    const auto [low, high] = std::pair(kTable[i - 1], kTable[i]);
    if (bounded > high.first) continue;
    return low.second +
           (high.second - low.second) * (bounded - low.first) / (high.first - low.first);
  }
  return kTable.back().second;
}

struct LiveEncoder::State {
  vpx_codec_ctx_t codec{};
  vpx_codec_enc_cfg_t config{};
  bool opened = false;
  Planes planes;
  vpx_codec_pts_t pictures = 0;

  State(int width_px, int height_px) : planes(width_px, height_px) {}
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    if (opened) vpx_codec_destroy(&codec);
  }
  [[nodiscard]] Error failure(const std::string& what) {
    const char* detail = vpx_codec_error_detail(&codec);
    return {ErrorCode::kInternal,
            "libvpx: " + what + ": " + vpx_codec_error(&codec) +
                (detail != nullptr ? std::string(", ") + detail : std::string())};
  }
  void set_quantiser(int quantiser) {
    config.rc_min_quantizer = static_cast<unsigned>(quantiser);
    config.rc_max_quantizer = static_cast<unsigned>(quantiser);
  }
};

LiveEncoder::LiveEncoder(std::unique_ptr<State> state) : state_(std::move(state)) {}
LiveEncoder::~LiveEncoder() = default;
LiveEncoder::LiveEncoder(LiveEncoder&&) noexcept = default;
LiveEncoder& LiveEncoder::operator=(LiveEncoder&&) noexcept = default;

int LiveEncoder::width_px() const { return static_cast<int>(state_->config.g_w); }
int LiveEncoder::height_px() const { return static_cast<int>(state_->config.g_h); }

Result<LiveEncoder> LiveEncoder::open(int width_px, int height_px) {
  if (Status status = check_side("width_px", width_px); !status) return status.error();
  if (Status status = check_side("height_px", height_px); !status) return status.error();
  auto state = std::make_unique<State>(width_px, height_px);
  vpx_codec_enc_cfg_t& config = state->config;
  if (vpx_codec_enc_config_default(vpx_codec_vp8_cx(), &config, 0) != VPX_CODEC_OK) {
    return Error{ErrorCode::kInternal, "libvpx: built without a VP8 encoder"};
  }
  config.g_w = static_cast<unsigned>(width_px);
  config.g_h = static_cast<unsigned>(height_px);
  config.g_timebase = {1, 1000};
  config.g_threads = 1;
  config.g_lag_in_frames = 0;
  // The quantiser is fixed, so the bit rate has no effect; no picture is ever left out.
  config.rc_end_usage = VPX_CBR;
  config.rc_target_bitrate = 100'000;
  config.rc_dropframe_thresh = 0;
  config.kf_mode = VPX_KF_DISABLED;  // only when asked for
  state->set_quantiser(quantiser_like_jpeg(75));
  if (vpx_codec_enc_init(&state->codec, vpx_codec_vp8_cx(), &config, 0) != VPX_CODEC_OK) {
    return state->failure("opening the encoder");
  }
  state->opened = true;
  if (vpx_codec_control(&state->codec, VP8E_SET_CPUUSED, kSpeed) != VPX_CODEC_OK) {
    return state->failure("setting the speed");
  }
  return LiveEncoder(std::move(state));
}

Result<LivePacket> LiveEncoder::encode(const Image& image, int quality, bool key) {
  State& state = *state_;
  if (image.width_px != width_px() || image.height_px != height_px()) {
    return Error{ErrorCode::kInvalidArgument,
                 "a picture of " + std::to_string(image.width_px) + " x " +
                     std::to_string(image.height_px) + " px: must be " +
                     std::to_string(width_px()) + " x " + std::to_string(height_px())};
  }
  const auto quantiser = static_cast<unsigned>(quantiser_like_jpeg(quality));
  if (quantiser != state.config.rc_max_quantizer) {
    state.set_quantiser(static_cast<int>(quantiser));
    if (vpx_codec_enc_config_set(&state.codec, &state.config) != VPX_CODEC_OK) {
      return state.failure("setting the quality");
    }
  }
  Planes& planes = state.planes;
  vpx_image_t input;
  if (image.channels == 1) {
    // libvpx only reads it.
    vpx_img_wrap(&input,
                 VPX_IMG_FMT_I420,
                 state.config.g_w,
                 state.config.g_h,
                 1,
                 const_cast<std::uint8_t*>(image.data.data()));
    std::fill(planes.u.begin(), planes.u.end(), 128);
    std::fill(planes.v.begin(), planes.v.end(), 128);
  } else {
    convert(image, &planes);
    vpx_img_wrap(&input, VPX_IMG_FMT_I420, state.config.g_w, state.config.g_h, 1, planes.y.data());
  }
  input.planes[VPX_PLANE_U] = planes.u.data();
  input.planes[VPX_PLANE_V] = planes.v.data();
  input.stride[VPX_PLANE_Y] = image.width_px;
  input.stride[VPX_PLANE_U] = input.stride[VPX_PLANE_V] = planes.chroma_width_px;
  const vpx_enc_frame_flags_t flags = key ? VPX_EFLAG_FORCE_KF : 0;
  if (vpx_codec_encode(
          &state.codec, &input, kPeriodMs * state.pictures++, kPeriodMs, flags, VPX_DL_REALTIME) !=
      VPX_CODEC_OK) {
    return state.failure("encoding a picture");
  }
  LivePacket made;
  vpx_codec_iter_t position = nullptr;
  while (const vpx_codec_cx_pkt_t* packet = vpx_codec_get_cx_data(&state.codec, &position)) {
    if (packet->kind != VPX_CODEC_CX_FRAME_PKT) continue;
    const auto* bytes = static_cast<const std::uint8_t*>(packet->data.frame.buf);
    made.bytes.insert(made.bytes.end(), bytes, bytes + packet->data.frame.sz);
    made.key = (packet->data.frame.flags & VPX_FRAME_IS_KEY) != 0;
  }
  if (made.bytes.empty()) return state.failure("a picture gave no data");
  return made;
}

}  // namespace overfly::server
