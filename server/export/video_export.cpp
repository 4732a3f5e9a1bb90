#include "server/export/video_export.hpp"

#include "core/cancel.hpp"
#include "server/export/frame_sequence.hpp"

namespace overfly::server {
namespace {

Status check_video_options(const VideoOptions& options) {
  std::error_code failed;
  if (std::filesystem::exists(std::filesystem::symlink_status(options.file, failed))) {
    return Error{ErrorCode::kConflict, options.file.string() + ": exists already"};
  }
  return options.look.validate();
}

}  // namespace

Result<VideoSummary> export_video(const ExportSource& source, const VideoOptions& options) {
  if (Status status = check_video_options(options); !status) return status.error();
  FrameMakerOptions making;
  making.renderer_factory = options.renderer_factory;
  making.cancel = options.cancel;
  making.notice = options.notice;
  FrameSpan span{options.from_s, options.to_s, {options.camera}};
  if (options.camera.empty()) span.cameras = {source.scenario.main_camera().name};
  const auto frames = FrameSequence::open(source, span, making);
  if (!frames) return frames.error();

  FlightVideo video(options.file, options.look, (*frames)->maker());
  VideoSummary summary;
  summary.attribution = (*frames)->maker().world().tiles->attribution();
  while (true) {
    if (is_cancelled(options.cancel)) {
      summary.cancelled = true;
      break;
    }
    Result<std::optional<MadeFrame>> frame = (*frames)->next();
    if (!frame && frame.error().code == ErrorCode::kCancelled) {
      summary.cancelled = true;
      break;
    }
    if (!frame) return frame.error();
    if (!frame->has_value()) break;
    if (Status status = video.add(**frame); !status) return status.error();
    ++summary.frames;
    if (options.progress) options.progress(summary.frames, (*frames)->count());
  }
  if (Status status = video.finish(source.scenario.rate); !status) return status.error();
  return summary;
}

}  // namespace overfly::server
