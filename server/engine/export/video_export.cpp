#include "server/engine/export/video_export.hpp"

#include <algorithm>
#include <utility>

#include "server/engine/export/frame_sequence.hpp"
#include "server/engine/export/video_panels.hpp"
#include "server/engine/export/vp9_encoder.hpp"
#include "server/engine/export/webm_file.hpp"

namespace overfly::engine {
namespace {

/// Pictures in, file out.
class Video {
 public:
  Video(const VideoOptions& options, FrameSequence& frames)
      : options_(options), chase_(frames.maker().renderer(), *frames.maker().world().tiles) {}

  Status add(const MadeFrame& frame) {
    Result<Image> picture = compose(frame);
    if (!picture) return picture.error().in("frame " + std::to_string(frame.frame));
    if (!encoder_) {
      if (Status status = open(*picture, frame.t_ns); !status) return status;
    }
    const std::int64_t t_ms = (frame.t_ns - begin_ns_ + 500'000) / 1'000'000;
    const auto packets = encoder_->encode(*picture, t_ms);
    if (!packets) return packets.error();
    for (const VideoPacket& packet : *packets) {
      if (Status status = file_->add(packet); !status) return status;
    }
    last_ms_ = t_ms;
    return {};
  }

  Status finish(const FrameRate& rate) {
    if (!file_) return {};
    return file_->finish(last_ms_ + frame_time_ns(1, rate) / 1'000'000);
  }

 private:
  [[nodiscard]] int factor(const Image& image) const {
    return (image.height_px + options_.max_height_px - 1) / options_.max_height_px;
  }

  Result<Image> compose(const MadeFrame& frame) {
    const Image& seen = frame.shots.front().image;
    Image camera = panel_from(seen, factor(seen));
    if (options_.view == VideoView::kCamera) return camera;
    Result<Image> chase = chase_.draw(frame.state.T_world_body, camera.width_px, camera.height_px);
    if (!chase || options_.view == VideoView::kChase) return chase;
    return side_by_side(camera, *chase);
  }

  Status open(const Image& first, std::int64_t t_ns) {
    begin_ns_ = t_ns;
    VideoSettings settings;
    settings.width_px = first.width_px;
    settings.height_px = first.height_px;
    settings.quality = options_.quality;
    auto encoder = Vp9Encoder::open(settings);
    if (!encoder) return encoder.error();
    encoder_.emplace(std::move(*encoder));
    auto file = WebmFile::create(options_.file, first.width_px, first.height_px);
    if (!file) return file.error();
    file_.emplace(std::move(*file));
    return {};
  }

  const VideoOptions& options_;
  ChasePanel chase_;
  std::optional<Vp9Encoder> encoder_;
  std::optional<WebmFile> file_;
  std::int64_t begin_ns_ = 0;
  std::int64_t last_ms_ = 0;
};

Status check(const VideoOptions& options) {
  if (options.max_height_px < 16) {
    return Error{
        ErrorCode::kInvalidArgument,
        "video.max_height_px = " + std::to_string(options.max_height_px) + ": must be at least 16"};
  }
  if (std::filesystem::exists(options.file)) {
    return Error{ErrorCode::kConflict, options.file.string() + ": exists already"};
  }
  return {};
}

}  // namespace

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

Result<VideoSummary> export_video(const ExportSource& source, const VideoOptions& options) {
  if (Status status = check(options); !status) return status.error();
  FrameMakerOptions making;
  making.renderer_factory = options.renderer_factory;
  making.cancel = options.cancel;
  making.notice = options.notice;
  FrameSpan span{options.from_s, options.to_s, {options.camera}};
  if (options.camera.empty()) span.cameras = {source.scenario.cameras.front().name};
  const auto frames = FrameSequence::open(source, span, making);
  if (!frames) return frames.error();

  Video video(options, **frames);
  VideoSummary summary;
  summary.attribution = (*frames)->maker().world().tiles->attribution();
  while (true) {
    if (options.cancel != nullptr && options.cancel->load()) {
      summary.cancelled = true;
      break;
    }
    Result<std::optional<MadeFrame>> frame = (*frames)->next();
    if (!frame) return frame.error();
    if (!frame->has_value()) break;
    if (Status status = video.add(**frame); !status) return status.error();
    ++summary.frames;
    if (options.progress) options.progress(summary.frames, (*frames)->count());
  }
  if (Status status = video.finish(source.scenario.rate); !status) return status.error();
  return summary;
}

}  // namespace overfly::engine
