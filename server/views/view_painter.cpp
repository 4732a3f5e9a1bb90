#include "server/views/view_painter.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "core/measure/processor_time.hpp"
#include "server/record/rows/rows.hpp"
#include "server/record/run_folder.hpp"
#include "server/timeline/poses_at.hpp"
#include "server/timeline/recorded_points.hpp"
#include "server/timeline/run_timeline.hpp"

namespace overfly::server {
namespace {

/// Of a viewer's runs, under two alignments, and a few more.
constexpr std::size_t kMaxRibbons = 40;

Audience::Kind audience_kind(const PictureRequest& request) {
  switch (request.kind) {
    case PictureRequest::Kind::kDebug:
      return Audience::Kind::kDebug;
    case PictureRequest::Kind::kScene:
      return Audience::Kind::kScene;
    case PictureRequest::Kind::kDepth:
      return Audience::Kind::kDepth;
    case PictureRequest::Kind::kError:
      return Audience::Kind::kError;
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
  const ViewedFrame frame{request.run_id, timeline.get(), *camera, *row};
  switch (request.kind) {
    case PictureRequest::Kind::kCamera:
      return frames_.camera(request, frame);
    case PictureRequest::Kind::kDebug:
      return frames_.debug(request, *timeline, *row);
    case PictureRequest::Kind::kScene:
      return paint_scene(request, timeline, *row);
    case PictureRequest::Kind::kDepth:
      return frames_.depth(request, frame);
    case PictureRequest::Kind::kError:
      return frames_.error(request, *timeline, frame);
  }
  return Error{ErrorCode::kInvalidArgument, "no such kind of picture"};
}

ViewPainter::Painted ViewPainter::paint_scene(const PictureRequest& request,
                                              const std::shared_ptr<RunTimeline>& timeline,
                                              const FrameRow& row) {
  auto view = renderers_.of_run(request.run_id);
  if (!view) return view.error();
  if (*view == nullptr) return std::optional<Picture>();
  const SceneSettings& settings = request.scene;
  // Only here, where no reference to one of them is held: a run may be scored at any time.
  ribbons_.remove_if([&](const ViewRibbons& known) {
    const bool was_read_again =
        known.timeline() != timeline && known.timeline()->info().id == request.run_id;
    return was_read_again || known.is_outdated();
  });
  ViewRibbons& ribbons = ribbons_of(timeline, request.alignment);
  ribbons.refresh();
  const terrain::TileSource& tiles = *(*view)->world->tiles;
  auto scene = scene_view(settings, row.T_world_body, ribbons.centre(), tiles);
  if (request.preview) scene.tile_wait_ns = kPreviewTileWaitNs;
  renderer::SceneContent content;
  std::vector<PlacedLabel> places;
  const bool onboard = settings.mode == SceneMode::kOnboard;
  add_run({request.run_id,
           *timeline,
           ribbons,
           compared_ribbons(timeline, request.compared),
           row.t_ns,
           row.T_world_body,
           request.look,
           Pose{},
           onboard},
          settings.show,
          &content,
          &places);
  if (settings.show.points) content.points = map_points(request, *timeline, ribbons, row);
  if (settings.show.frustum || settings.show.footprint) {
    content.frustum = renderer::SceneContent::Frustum{timeline->main_camera().model,
                                                      row.T_world_camera,
                                                      settings.show.frustum && !onboard,
                                                      settings.show.footprint};
  }
  const Geodetic origin = tiles.frame().origin();
  for (const SceneTracks& tracks : request.others) {
    add_tracks(tracks, request.compared, origin, settings.show, &content, &places);
  }
  if (settings.show.image) {
    // Without the image, if there is none: the camera's own picture tells why.
    auto projection = frames_.projection({request.run_id, timeline.get(), kMainCamera, row});
    if (projection) content.projection = std::move(*projection);
  }
  // Frames may have been made again meanwhile: that keeps the view.
  auto image = (*view)->renderer->render_scene(scene, content);
  if (!image) return image.error();
  const auto shared = std::make_shared<const Image>(std::move(*image));
  PictureRequest coding = request;
  coding.max_width_px = shared->width_px;
  auto picture = encoder_.encode({row.frame, row.t_ns, shared}, coding);
  if (!picture) return picture.error();
  // After the first picture, so that a jump to any other instant finds its ground sampled.
  bool& expected = (*view)->runs.front().scenes_expected;
  if (!request.live && !expected) {
    expected = true;
    (*view)->renderer->expect_scenes(scene_views_along(*timeline, settings));
  }
  if (settings.show.labels) picture->labels = labels_in_view(places, scene, tiles);
  return std::optional(std::move(*picture));
}

void ViewPainter::add_tracks(const SceneTracks& tracks,
                             const std::string& compared,
                             const Geodetic& origin,
                             const SceneShow& show,
                             renderer::SceneContent* content,
                             std::vector<PlacedLabel>* places) {
  const auto timeline = runs_.timeline(tracks.run_id);
  if (!timeline) return;
  const auto row =
      (*timeline)->frame_at(tracks.live ? std::numeric_limits<std::int64_t>::max() : tracks.t_ns);
  const std::optional<Geodetic> other_origin = (*timeline)->info().origin;
  if (!row || !other_origin) return;
  ViewRibbons& ribbons = ribbons_of(*timeline, tracks.alignment);
  ribbons.refresh();
  const std::int64_t t_ns = tracks.live ? row->t_ns : tracks.t_ns;
  add_run({tracks.run_id,
           **timeline,
           ribbons,
           compared_ribbons(*timeline, compared),
           t_ns,
           truth_at(**timeline, *row, t_ns),
           tracks.look,
           T_world_other(origin, *other_origin),
           false},
          show,
          content,
          places);
}

std::vector<Eigen::Vector3f> ViewPainter::map_points(const PictureRequest& request,
                                                     const RunTimeline& timeline,
                                                     const ViewRibbons& ribbons,
                                                     const FrameRow& row) {
  std::vector<Eigen::Vector3f> all;
  const auto folder = runs_.folder(request.run_id);
  for (std::size_t i = 0; i < timeline.estimators().size(); ++i) {
    if (!request.look.shows(timeline.estimators()[i])) continue;
    std::vector<Eigen::Vector3f> points;
    if (request.live) {
      points = timeline.live_points(i);
    } else if (const auto& alignment = ribbons.alignment_of(i); folder && alignment) {
      points = recorded_points(*folder, numbers_, timeline, i, *alignment, row);
    }
    all.insert(all.end(), points.begin(), points.end());
  }
  return all;
}

const ViewRibbons* ViewPainter::compared_ribbons(const std::shared_ptr<RunTimeline>& timeline,
                                                 const std::string& alignment) {
  if (alignment.empty()) return nullptr;
  ViewRibbons& ribbons = ribbons_of(timeline, alignment);
  ribbons.refresh();
  return &ribbons;
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
