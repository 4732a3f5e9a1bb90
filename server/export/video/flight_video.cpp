#include "server/export/video/flight_video.hpp"

#include <utility>

#include "core/time.hpp"

namespace overfly::server {

const char* to_string(VideoView view) {
  if (view == VideoView::kCamera) return "camera";
  return view == VideoView::kChase ? "chase" : "both";
}

std::optional<VideoView> video_view_from(const std::string& text) {
  for (const VideoView view : {VideoView::kCamera, VideoView::kChase, VideoView::kBoth}) {
    if (text == to_string(view)) return view;
  }
  return std::nullopt;
}

Status VideoLook::validate() const {
  const auto refused = [](const char* field, int value, const char* limit) {
    return Error{
        ErrorCode::kInvalidArgument,
        std::string("video.") + field + " = " + std::to_string(value) + ": must be " + limit};
  };
  if (quality < 1 || quality > 100) return refused("quality", quality, "in [1, 100]");
  if (max_height_px < 16) return refused("max_height_px", max_height_px, "at least 16");
  return {};
}

FlightVideo::FlightVideo(std::filesystem::path file, const VideoLook& look, FrameMaker& maker)
    : path_(std::move(file)), look_(look), chase_(maker.renderer(), *maker.world().tiles) {}

Status FlightVideo::add(const MadeFrame& frame) {
  const Result<Image> picture = compose(frame);
  if (!picture) return picture.error().in("video of frame " + std::to_string(frame.frame));
  if (!encoder_) {
    if (Status status = open(*picture, frame.t_ns); !status) return status;
  }
  const std::int64_t t_ms = (frame.t_ns - begin_ns_ + 500'000) / 1'000'000;
  const auto packets = encoder_->encode(*picture, t_ms);
  if (!packets) return packets.error().in("video of frame " + std::to_string(frame.frame));
  for (const VideoPacket& packet : *packets) {
    if (Status status = file_->add(packet); !status) return status;
  }
  last_ms_ = t_ms;
  return {};
}

Status FlightVideo::finish(const FrameRate& rate) {
  if (!file_) return {};
  return file_->finish(last_ms_ + frame_time_ns(1, rate) / 1'000'000);
}

Result<Image> FlightVideo::compose(const MadeFrame& frame) {
  const CameraShot& shot = frame.shots.front();
  // A recorded image that could not be read is black.
  const PinholeCamera& camera_size = shot.drawn.camera.pinhole();
  const Image missing =
      shot.image.empty() ? Image(camera_size.width_px, camera_size.height_px, 1) : Image();
  const Image& seen = shot.image.empty() ? missing : shot.image;
  const int factor = (seen.height_px + look_.max_height_px - 1) / look_.max_height_px;
  Image camera = panel_from(seen, factor);
  if (look_.view == VideoView::kCamera) return camera;
  Result<Image> chase = chase_.draw(frame.state.T_world_body, camera.width_px, camera.height_px);
  if (!chase || look_.view == VideoView::kChase) return chase;
  return side_by_side(camera, *chase);
}

Status FlightVideo::open(const Image& first, std::int64_t t_ns) {
  begin_ns_ = t_ns;
  VideoSettings settings;
  settings.width_px = first.width_px;
  settings.height_px = first.height_px;
  settings.quality = look_.quality;
  auto encoder = Vp9Encoder::open(settings);
  if (!encoder) return encoder.error();
  encoder_.emplace(std::move(*encoder));
  auto file = WebmFile::create(path_, first.width_px, first.height_px);
  if (!file) return file.error();
  file_.emplace(std::move(*file));
  return {};
}

}  // namespace overfly::server
