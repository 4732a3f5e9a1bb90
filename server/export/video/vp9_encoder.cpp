#include "server/export/video/vp9_encoder.hpp"

#include <vpx/vp8cx.h>
#include <vpx/vpx_encoder.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

namespace overfly::server {
namespace {

Error refused(const char* field, int value, const std::string& limit) {
  return {ErrorCode::kInvalidArgument,
          std::string("video.") + field + " = " + std::to_string(value) + ": must be " + limit};
}

Status check_settings(const VideoSettings& settings) {
  for (const auto& [field, value] :
       {std::pair{"width_px", settings.width_px}, {"height_px", settings.height_px}}) {
    if (value < 16 || value > 16384 || value % 2 != 0) {
      return refused(field, value, "even and in [16, 16384]");
    }
  }
  if (settings.quality < 1 || settings.quality > 100) {
    return refused("quality", settings.quality, "in [1, 100]");
  }
  if (settings.key_every < 1) return refused("key_every", settings.key_every, "at least 1");
  return {};
}

/// Quality 100 is the finest useful quantiser, 1 the coarsest.
int quantiser_of(int quality) { return 4 + (100 - quality) * 59 / 99; }

std::uint8_t byte_of(int scaled) {
  return static_cast<std::uint8_t>(std::clamp((scaled + 32768) >> 16, 0, 255));
}

}  // namespace

PlanarImage planar_from_rgb(const Image& rgb) {
  // BT.709 in units of 1/65536: Kr = 0.2126, Kb = 0.0722; 219 and 224 of 255 steps.
  constexpr int kShift = 65536;
  PlanarImage planar;
  planar.width_px = rgb.width_px;
  planar.height_px = rgb.height_px;
  const std::size_t pixels = static_cast<std::size_t>(rgb.width_px) * rgb.height_px;
  planar.y.resize(pixels);
  planar.u.resize(pixels / 4);
  planar.v.resize(pixels / 4);
  for (int y = 0; y < rgb.height_px; ++y) {
    for (int x = 0; x < rgb.width_px; ++x) {
      const std::uint8_t* p = &rgb.at(x, y);
      planar.y[static_cast<std::size_t>(y) * rgb.width_px + x] =
          byte_of(16 * kShift + 11966 * p[0] + 40254 * p[1] + 4064 * p[2]);
    }
  }
  std::size_t at = 0;
  for (int y = 0; y < rgb.height_px; y += 2) {
    for (int x = 0; x < rgb.width_px; x += 2, ++at) {
      int mean[3];
      for (int c = 0; c < 3; ++c) {
        mean[c] = (rgb.at(x, y, c) + rgb.at(x + 1, y, c) + rgb.at(x, y + 1, c) +
                   rgb.at(x + 1, y + 1, c) + 2) /
                  4;
      }
      planar.u[at] = byte_of(128 * kShift - 6596 * mean[0] - 22189 * mean[1] + 28785 * mean[2]);
      planar.v[at] = byte_of(128 * kShift + 28785 * mean[0] - 26145 * mean[1] - 2640 * mean[2]);
    }
  }
  return planar;
}

struct Vp9Encoder::State {
  vpx_codec_ctx_t codec{};
  bool opened = false;
  VideoSettings settings;
  std::optional<std::int64_t> last_ms;

  ~State() {
    if (opened) vpx_codec_destroy(&codec);
  }
  [[nodiscard]] Error failure(const std::string& what) {
    const char* detail = vpx_codec_error_detail(&codec);
    return {ErrorCode::kInternal,
            "libvpx: " + what + ": " + vpx_codec_error(&codec) +
                (detail != nullptr ? std::string(", ") + detail : std::string())};
  }
};

Vp9Encoder::Vp9Encoder(std::unique_ptr<State> state) : state_(std::move(state)) {}
Vp9Encoder::~Vp9Encoder() = default;
Vp9Encoder::Vp9Encoder(Vp9Encoder&&) noexcept = default;
Vp9Encoder& Vp9Encoder::operator=(Vp9Encoder&&) noexcept = default;

Result<Vp9Encoder> Vp9Encoder::open(const VideoSettings& settings) {
  if (Status status = check_settings(settings); !status) return status.error();
  auto state = std::make_unique<State>();
  state->settings = settings;
  vpx_codec_enc_cfg_t config;
  if (vpx_codec_enc_config_default(vpx_codec_vp9_cx(), &config, 0) != VPX_CODEC_OK) {
    return Error{ErrorCode::kInternal, "libvpx: built without a VP9 encoder"};
  }
  config.g_w = static_cast<unsigned>(settings.width_px);
  config.g_h = static_cast<unsigned>(settings.height_px);
  config.g_timebase = {1, 1000};
  config.g_threads = 1;
  config.g_lag_in_frames = 0;
  config.rc_end_usage = VPX_Q;
  config.kf_max_dist = static_cast<unsigned>(settings.key_every);
  if (vpx_codec_enc_init(&state->codec, vpx_codec_vp9_cx(), &config, 0) != VPX_CODEC_OK) {
    return state->failure("opening the encoder");
  }
  state->opened = true;
  constexpr int kSpeed = 6;
  const bool set =
      vpx_codec_control(&state->codec, VP8E_SET_CPUUSED, kSpeed) == VPX_CODEC_OK &&
      vpx_codec_control(&state->codec, VP8E_SET_CQ_LEVEL, quantiser_of(settings.quality)) ==
          VPX_CODEC_OK &&
      vpx_codec_control(&state->codec, VP9E_SET_COLOR_SPACE, VPX_CS_BT_709) == VPX_CODEC_OK &&
      vpx_codec_control(&state->codec, VP9E_SET_COLOR_RANGE, VPX_CR_STUDIO_RANGE) == VPX_CODEC_OK;
  if (!set) return state->failure("setting quality and colour");
  return Vp9Encoder(std::move(state));
}

Result<std::vector<VideoPacket>> Vp9Encoder::encode(const Image& rgb, std::int64_t t_ms) {
  const VideoSettings& settings = state_->settings;
  if (rgb.width_px != settings.width_px || rgb.height_px != settings.height_px ||
      rgb.channels != 3) {
    return Error{ErrorCode::kInvalidArgument,
                 "video: an image of " + std::to_string(rgb.width_px) + " x " +
                     std::to_string(rgb.height_px) + " px, " + std::to_string(rgb.channels) +
                     " channels: must be RGB of " + std::to_string(settings.width_px) + " x " +
                     std::to_string(settings.height_px)};
  }
  if (state_->last_ms && t_ms <= *state_->last_ms) {
    return Error{ErrorCode::kInvalidArgument,
                 "video: an image at " + std::to_string(t_ms) + " ms after one at " +
                     std::to_string(*state_->last_ms) + " ms: stamps must increase"};
  }
  state_->last_ms = t_ms;
  PlanarImage planar = planar_from_rgb(rgb);
  const auto width = static_cast<unsigned>(settings.width_px);
  vpx_image_t image;
  vpx_img_wrap(&image,
               VPX_IMG_FMT_I420,
               width,
               static_cast<unsigned>(settings.height_px),
               1,
               planar.y.data());
  image.planes[VPX_PLANE_U] = planar.u.data();
  image.planes[VPX_PLANE_V] = planar.v.data();
  image.stride[VPX_PLANE_Y] = settings.width_px;
  image.stride[VPX_PLANE_U] = image.stride[VPX_PLANE_V] = settings.width_px / 2;
  constexpr unsigned long kDurationMs = 1;
  if (vpx_codec_encode(&state_->codec, &image, t_ms, kDurationMs, 0, VPX_DL_REALTIME) !=
      VPX_CODEC_OK) {
    return state_->failure("encoding the image at " + std::to_string(t_ms) + " ms");
  }
  std::vector<VideoPacket> packets;
  vpx_codec_iter_t position = nullptr;
  while (const vpx_codec_cx_pkt_t* packet = vpx_codec_get_cx_data(&state_->codec, &position)) {
    if (packet->kind != VPX_CODEC_CX_FRAME_PKT) continue;
    const auto* bytes = static_cast<const std::uint8_t*>(packet->data.frame.buf);
    packets.push_back({{bytes, bytes + packet->data.frame.sz},
                       packet->data.frame.pts,
                       (packet->data.frame.flags & VPX_FRAME_IS_KEY) != 0});
  }
  return packets;
}

}  // namespace overfly::server
