#include "server/views/view_painter.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "core/measure/processor_time.hpp"
#include "server/record/rows/rows.hpp"
#include "server/record/run_folder.hpp"
#include "server/timeline/recorded_points.hpp"
#include "server/timeline/run_timeline.hpp"
#include "server/views/view_scene.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

/// Of a viewer's runs, and a few more.
constexpr std::size_t kMaxRibbons = 20;

Audience::Kind audience_kind(const PictureRequest& request) {
  switch (request.kind) {
    case PictureRequest::Kind::kDebug:
      return Audience::Kind::kDebug;
    case PictureRequest::Kind::kScene:
      return Audience::Kind::kScene;
    case PictureRequest::Kind::kCamera:
      break;
  }
  return Audience::Kind::kCamera;
}

std::optional<FrameRow> row_of(const RunTimeline& timeline,
                               const PictureRequest& request,
                               std::size_t camera) {
  if (!request.live) return timeline.frame_at(request.t_ns, camera);
  return timeline.frame_at(std::numeric_limits<std::int64_t>::max(), camera);
}

/// Stamp of a frame at or before `row`. Row i holds frame i, or a later frame if some were skipped.
std::int64_t stamp_before(const RunTimeline& timeline, const FrameRow& row, std::int64_t frame) {
  if (frame == row.frame) return row.t_ns;
  const auto count = static_cast<std::int64_t>(timeline.frame_count());
  for (std::int64_t i = std::min(frame, count - 1); i >= 0; --i) {
    const FrameRow before = timeline.frames(static_cast<std::size_t>(i), 1).front();
    if (before.frame <= frame) return before.t_ns;
  }
  return row.t_ns;
}

ViewPainter::Painted painted(Result<Picture> picture) {
  if (!picture) return picture.error();
  return std::optional<Picture>(std::move(*picture));
}

}  // namespace

ViewPainter::Painted ViewPainter::paint(const PictureRequest& request) {
  const double before_s = thread_cpu_s();
  auto timeline = runs_.timeline(request.run_id);
  if (!timeline) return timeline.error();
  Painted picture = paint_of(request, *timeline);
  if (picture && !*picture) return picture;
  if (picture) {
    (*timeline)->audience()->picture_made(audience_kind(request), thread_cpu_s() - before_s);
  }
  runs_.picture_rate().picture_made();
  return picture;
}

ViewPainter::Painted ViewPainter::paint_of(const PictureRequest& request,
                                           const std::shared_ptr<RunTimeline>& timeline) {
  const Result<std::size_t> camera = timeline->camera_index(request.camera);
  if (!camera) return camera.error();
  const auto row = row_of(*timeline, request, *camera);
  if (!row) return Error{ErrorCode::kNotFound, "run " + request.run_id + " has no frame yet"};
  switch (request.kind) {
    case PictureRequest::Kind::kCamera:
      return paint_camera(request, *timeline, *camera, *row);
    case PictureRequest::Kind::kDebug:
      return paint_debug(request, *timeline, *row);
    case PictureRequest::Kind::kScene:
      return paint_scene(request, timeline, *row);
  }
  return Error{ErrorCode::kInvalidArgument, "no such kind of picture"};
}

ViewPainter::Painted ViewPainter::paint_camera(const PictureRequest& request,
                                               const RunTimeline& timeline,
                                               std::size_t camera,
                                               const FrameRow& row) {
  const auto live = timeline.live_camera(camera);
  if (live && live->image && (request.live || live->frame == row.frame)) {
    return painted(encoder_.encode(*live, request.quality, request.max_width_px));
  }
  const auto folder = runs_.folder(request.run_id);
  if (!folder) return folder.error();
  const fs::path recorded = CameraFiles(*folder, camera, request.camera).image(row.frame);
  std::error_code error;
  if (fs::is_regular_file(recorded, error)) {
    return painted(
        encoder_.encode_file(recorded, row.frame, row.t_ns, request.quality, request.max_width_px));
  }
  Result<std::optional<Image>> made = renderers_.remake(request.run_id, camera, row);
  if (!made) return made.error();
  if (!*made) return std::optional<Picture>();
  const auto image = std::make_shared<const Image>(std::move(**made));
  return painted(
      encoder_.encode({row.frame, row.t_ns, image}, request.quality, request.max_width_px));
}

ViewPainter::Painted ViewPainter::paint_debug(const PictureRequest& request,
                                              const RunTimeline& timeline,
                                              const FrameRow& row) {
  if (request.estimator >= timeline.estimators().size()) {
    return Error{ErrorCode::kInvalidArgument,
                 "estimator = " + std::to_string(request.estimator) + ": must be below " +
                     std::to_string(timeline.estimators().size())};
  }
  const auto live = timeline.live_debug(request.estimator);
  if (live && live->image && (request.live || live->frame == row.frame)) {
    return painted(encoder_.encode(*live, request.quality, request.max_width_px));
  }
  const auto folder = runs_.folder(request.run_id);
  if (!folder) return folder.error();
  const std::string& name = timeline.estimators()[request.estimator];
  const auto frame =
      last_recorded_frame(debug_image_file(*folder, name, 0).parent_path(), row.frame);
  if (!frame) {
    return Error{ErrorCode::kNotFound,
                 "estimator " + name + " has no picture up to frame " + std::to_string(row.frame)};
  }
  return painted(encoder_.encode_file(debug_image_file(*folder, name, *frame),
                                      *frame,
                                      stamp_before(timeline, row, *frame),
                                      request.quality,
                                      request.max_width_px));
}

ViewPainter::Painted ViewPainter::paint_scene(const PictureRequest& request,
                                              const std::shared_ptr<RunTimeline>& timeline,
                                              const FrameRow& row) {
  auto view = renderers_.of_run(request.run_id);
  if (!view) return view.error();
  if (*view == nullptr) return std::optional<Picture>();
  ViewRibbons& ribbons = ribbons_of(timeline, request.alignment);
  ribbons.refresh();
  const auto scene =
      scene_view(request.scene, row.T_world_body, ribbons.centre(), *(*view)->world->tiles);
  auto points = map_points(request, *timeline, ribbons, row);
  auto content = scene_content(*timeline, ribbons, row, std::move(points), request.first_colour);
  const Geodetic& origin = (*view)->world->tiles->frame().origin();
  for (const SceneTracks& tracks : request.others) add_tracks(tracks, origin, &content);
  auto image = (*view)->renderer->render_scene(scene, content);
  if (!image) return image.error();
  const auto shared = std::make_shared<const Image>(std::move(*image));
  return painted(encoder_.encode({row.frame, row.t_ns, shared}, request.quality, shared->width_px));
}

void ViewPainter::add_tracks(const SceneTracks& tracks,
                             const Geodetic& origin,
                             renderer::SceneContent* content) {
  const auto timeline = runs_.timeline(tracks.run_id);
  if (!timeline) return;
  const std::int64_t t_ns = tracks.live ? std::numeric_limits<std::int64_t>::max() : tracks.t_ns;
  const auto row = (*timeline)->frame_at(t_ns);
  const std::optional<Geodetic> other_origin = (*timeline)->info().origin;
  if (!row || !other_origin) return;
  ViewRibbons& ribbons = ribbons_of(*timeline, tracks.alignment);
  ribbons.refresh();
  const Pose T_scene_other = T_world_other(origin, *other_origin);
  add_other_run(**timeline, ribbons, *row, T_scene_other, tracks.first_colour, content);
}

std::vector<Eigen::Vector3f> ViewPainter::map_points(const PictureRequest& request,
                                                     const RunTimeline& timeline,
                                                     const ViewRibbons& ribbons,
                                                     const FrameRow& row) {
  std::vector<Eigen::Vector3f> all;
  const auto folder = runs_.folder(request.run_id);
  for (std::size_t i = 0; i < timeline.estimators().size(); ++i) {
    std::vector<Eigen::Vector3f> points;
    if (request.live) {
      points = timeline.live_points(i);
    } else if (const auto& alignment = ribbons.alignment_of(i); folder && alignment) {
      points = recorded_points(*folder, timeline, i, *alignment, row);
    }
    all.insert(all.end(), points.begin(), points.end());
  }
  return all;
}

ViewRibbons& ViewPainter::ribbons_of(const std::shared_ptr<RunTimeline>& timeline,
                                     const std::string& alignment) {
  const auto known =
      std::find_if(ribbons_.begin(), ribbons_.end(), [&](const ViewRibbons& ribbons) {
        return ribbons.timeline() == timeline && ribbons.alignment() == alignment;
      });
  if (known != ribbons_.end()) {
    ribbons_.splice(ribbons_.begin(), ribbons_, known);
  } else {
    ribbons_.emplace_front(timeline, alignment);
    if (ribbons_.size() > kMaxRibbons) ribbons_.pop_back();
  }
  return ribbons_.front();
}

}  // namespace overfly::server
