#include "server/views/images/frame_painter.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include "core/text/number_text.hpp"
#include "server/camera/camera_shot.hpp"
#include "server/record/run_folder.hpp"
#include "server/timeline/row_alignment.hpp"
#include "server/views/images/line_of_sight.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

/// The frame of an estimate, and the pose that it gives the camera.
struct EstimatedView {
  ViewedFrame frame;
  Pose T_world_camera;
};

/// The newest estimate at or before t. Errors: kNotFound if it does not track.
Result<EstimatedView> estimated_view(const std::string& run_id,
                                     const RunTimeline& timeline,
                                     std::size_t estimator,
                                     const std::string& alignment,
                                     std::int64_t t_ns) {
  const Result<RowAlignment> place = RowAlignment::of(timeline, estimator, alignment);
  if (!place) return Error{ErrorCode::kNotFound, place.error().message};
  const Error none{ErrorCode::kNotFound,
                   "estimator " + timeline.estimators()[estimator] + " has no pose at " +
                       std::to_string(t_ns) + " ns"};
  const auto estimate = timeline.estimate_at(estimator, t_ns);
  const auto T_world_body = estimate ? place->T_world_body(*estimate) : std::nullopt;
  if (!T_world_body) return none;
  const std::size_t camera = camera_of_estimator(timeline, estimator);
  const auto row = timeline.frame_at(estimate->sample.t_ns, camera);
  if (!row || row->frame != estimate->sample.frame) return none;
  const Pose T_world_camera = *T_world_body * timeline.cameras().at(camera).T_body_camera;
  return EstimatedView{{run_id, &timeline, camera, *row}, T_world_camera};
}

Status check_estimator(const RunTimeline& timeline, std::size_t estimator) {
  if (estimator < timeline.estimators().size()) return {};
  return Error{ErrorCode::kInvalidArgument,
               "estimator = " + std::to_string(estimator) + ": must be below " +
                   std::to_string(timeline.estimators().size())};
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

FramePainter::Painted painted(Result<Picture> picture) {
  if (!picture) return picture.error();
  return std::optional<Picture>(std::move(*picture));
}

/// Checks that a pixel lies in an image.
Status check_pixel(const PixelRequest& request, const PinholeCamera& camera) {
  const auto check = [](const char* field, double value, int size_px) -> Status {
    if (value >= -0.5 && value < size_px - 0.5) return {};
    return Error{ErrorCode::kInvalidArgument,
                 std::string(field) + " = " + number_text(value) + ": must be in [-0.5, " +
                     number_text(size_px - 0.5) + ")"};
  };
  if (Status status = check("x_px", request.x_px, camera.width_px); !status) return status;
  return check("y_px", request.y_px, camera.height_px);
}

/// The pixel that contains a coordinate of [-0.5, size_px - 0.5).
int nearest_pixel(double coordinate_px, int size_px) {
  return std::clamp(static_cast<int>(std::lround(coordinate_px)), 0, size_px - 1);
}

/// The grey level and, of a colour image, the colour of a pixel.
void read_pixel(const Image& image, int x_px, int y_px, PixelValue* value) {
  Image one(1, 1, image.channels);
  for (int c = 0; c < image.channels; ++c) one.at(0, 0, c) = image.at(x_px, y_px, c);
  if (image.channels == 3) value->rgb = {one.at(0, 0, 0), one.at(0, 0, 1), one.at(0, 0, 2)};
  value->grey = grey_of(one).at(0, 0);
}

}  // namespace

FramePainter::Painted FramePainter::camera(const PictureRequest& request,
                                           const ViewedFrame& frame) {
  const FrameRow& row = frame.row;
  const auto folder = runs_.folder(request.run_id);
  if (!folder) return folder.error();
  const auto live = frame.timeline->live_camera(frame.camera);
  if (request.live && live && live->image) {
    images_.remember(frame, *live);
    return painted(encoder_.encode(*live, request));
  }
  const fs::path recorded = CameraFiles(*folder, frame.camera, request.camera).image(row.frame);
  std::error_code error;
  if (fs::is_regular_file(recorded, error)) {
    return painted(encoder_.encode_file(recorded, row.frame, row.t_ns, request));
  }
  if (request.preview) {
    const auto half = images_.preview(frame);
    if (!half) return half.error();
    if (!*half) return std::optional<Picture>();
    if (**half) return previewed(request, frame, **half);
  }
  const auto image = images_.received(frame);
  if (!image) return image.error();
  if (!*image) return std::optional<Picture>();
  return painted(encoder_.encode({row.frame, row.t_ns, **image}, request));
}

FramePainter::Painted FramePainter::previewed(const PictureRequest& request,
                                              const ViewedFrame& frame,
                                              const std::shared_ptr<const Image>& half) {
  Result<Picture> picture = encoder_.encode({frame.row.frame, frame.row.t_ns, half}, request);
  if (!picture) return picture.error();
  const PinholeCamera& whole = frame.timeline->cameras()[frame.camera].model.pinhole();
  picture->full_width_px = whole.width_px;
  picture->full_height_px = whole.height_px;
  picture->preview = true;
  return painted(std::move(picture));
}

FramePainter::Painted FramePainter::depth(const PictureRequest& request, const ViewedFrame& frame) {
  const auto depth = images_.depth(frame, request.max_width_px);
  if (!depth) return depth.error();
  if (!*depth) return std::optional<Picture>();
  return scaled(request, frame, **depth);
}

FramePainter::Painted FramePainter::error(const PictureRequest& request,
                                          const RunTimeline& timeline,
                                          const ViewedFrame& frame) {
  const auto view = compared_view(request.error, timeline, request.alignment, frame);
  if (!view) return view.error();
  const auto difference = images_.difference(view->frame, view->comparison);
  if (!difference) return difference.error();
  if (!*difference) return std::optional<Picture>();
  return scaled(request, view->frame, **difference);
}

FramePainter::Painted FramePainter::scaled(const PictureRequest& request,
                                           const ViewedFrame& frame,
                                           const ScaledImage& image) {
  return painted(encoder_.encode({frame.row.frame, frame.row.t_ns, image.image},
                                 *image.scale,
                                 frame.timeline->cameras()[frame.camera].model.pinhole(),
                                 request));
}

Result<FramePainter::ComparedView> FramePainter::compared_view(const ErrorOf& error,
                                                               const RunTimeline& timeline,
                                                               const std::string& alignment,
                                                               const ViewedFrame& frame) {
  if (!error.estimator) return ComparedView{frame, {}};
  if (Status status = check_estimator(timeline, *error.estimator); !status) return status.error();
  const auto estimated =
      estimated_view(frame.run_id, timeline, *error.estimator, alignment, frame.row.t_ns);
  if (!estimated) return estimated.error();
  return ComparedView{estimated->frame, {estimated->T_world_camera}};
}

FramePainter::Probed FramePainter::probe(const PixelRequest& request) {
  const auto timeline = runs_.timeline(request.run_id);
  if (!timeline) return timeline.error();
  const Result<std::size_t> camera = (*timeline)->camera_index(request.camera);
  if (!camera) return camera.error();
  const auto row = (*timeline)->frame_at(request.t_ns, *camera);
  if (!row) return Error{ErrorCode::kNotFound, "run " + request.run_id + " has no frame yet"};
  const RunCamera seen_by = (*timeline)->cameras()[*camera];
  if (Status status = check_pixel(request, seen_by.model.pinhole()); !status) {
    return status.error();
  }
  const ViewedFrame frame{request.run_id, timeline->get(), *camera, *row};
  const auto image = images_.received(frame);
  if (!image) return image.error();
  if (!*image) return std::optional<PixelValue>();
  const Image& whole = ***image;
  const int x_px = nearest_pixel(request.x_px, whole.width_px);
  const int y_px = nearest_pixel(request.y_px, whole.height_px);
  PixelValue value;
  value.frame = row->frame;
  value.t_ns = row->t_ns;
  value.camera = seen_by.name;
  value.width_px = whole.width_px;
  value.height_px = whole.height_px;
  read_pixel(whole, x_px, y_px, &value);
  if (request.error) {
    const auto view = compared_view(*request.error, **timeline, request.alignment, frame);
    if (!view) return view.error();
    if (view->frame.camera != *camera) {
      return Error{ErrorCode::kInvalidArgument,
                   "picture: estimator \"" + (*timeline)->estimators()[*request.error->estimator] +
                       "\" uses camera \"" + (*timeline)->cameras()[view->frame.camera].name +
                       "\", but the pixel is of camera \"" + seen_by.name + "\""};
    }
    const auto difference = images_.difference_at(view->frame, view->comparison, x_px, y_px);
    if (!difference) return difference.error();
    if (!*difference) return std::optional<PixelValue>();
    value.difference = **difference;
  }
  const auto opened = find_ground(frame, {request.x_px, request.y_px}, &value);
  if (!opened) return opened.error();
  if (!*opened) return std::optional<PixelValue>();
  return std::optional(std::move(value));
}

Result<bool> FramePainter::find_ground(const ViewedFrame& frame,
                                       const Eigen::Vector2d& pixel,
                                       PixelValue* value) {
  const auto again = renderers_.frames_of(frame.run_id);
  if (!again) return again.error();
  if (!*again) return false;
  const auto request = drawn_request(frame, (*again)->maker);
  if (!request) return request.error();
  const terrain::TileSource& tiles = *(*again)->world.tiles;
  const auto sight = ground_sight(*request, pixel, tiles);
  if (!sight) return true;
  value->ground_world_m = sight->ground_world_m;
  value->ground = tiles.frame().geodetic_from_world(sight->ground_world_m);
  value->depth_m = sight->depth_m;
  value->range_m = sight->range_m;
  return true;
}

FramePainter::Painted FramePainter::debug(const PictureRequest& request,
                                          const RunTimeline& timeline,
                                          const FrameRow& row) {
  if (Status status = check_estimator(timeline, request.estimator); !status) return status.error();
  const auto live = timeline.live_debug(request.estimator);
  if (live && live->image && (request.live || live->frame == row.frame)) {
    return painted(encoder_.encode(*live, request));
  }
  const auto folder = runs_.folder(request.run_id);
  if (!folder) return folder.error();
  const std::string& name = timeline.estimators()[request.estimator];
  const auto frame = numbers_.last(debug_image_file(*folder, name, 0).parent_path(), row.frame);
  if (!frame) {
    return Error{ErrorCode::kNotFound,
                 "estimator " + name + " has no picture up to frame " + std::to_string(row.frame)};
  }
  return painted(encoder_.encode_file(debug_image_file(*folder, name, *frame),
                                      *frame,
                                      stamp_before(timeline, row, *frame),
                                      request));
}

}  // namespace overfly::server
