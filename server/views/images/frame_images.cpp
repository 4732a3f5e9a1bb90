#include "server/views/images/frame_images.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/camera/halved_image.hpp"
#include "core/outside/file_text.hpp"
#include "core/text/number_text.hpp"
#include "server/files/jpeg.hpp"
#include "server/record/run_folder.hpp"
#include "server/views/images/colour_map.hpp"
#include "server/views/view_encoding.hpp"

namespace overfly::server {
namespace {

/// Of the images kept; at least the images of one frame are.
constexpr std::size_t kMostBytes = std::size_t{48} << 20U;
constexpr std::size_t kLeastKept = 4;
constexpr std::uint64_t kMostFileBytes = std::uint64_t{256} << 20U;

std::string key_of(const char* what, const ViewedFrame& frame, const std::string& more = {}) {
  return std::string(what) + '|' + frame.run_id + '|' + std::to_string(frame.camera) + '|' +
         std::to_string(frame.row.frame) + '|' + more;
}

std::string pose_key(const Pose& pose) {
  const Eigen::Vector3d& p = pose.translation;
  const Eigen::Quaterniond& q = pose.rotation;
  std::string text;
  for (const double value : {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()}) {
    text += number_text(value) + ' ';
  }
  return text;
}

}  // namespace

Result<renderer::CameraRequest> drawn_request(const ViewedFrame& frame, FrameRemaker& maker) {
  auto request = maker.request(frame.camera, frame.row);
  if (request || request.error().code != ErrorCode::kConflict) return request;
  return renderer::CameraRequest::still(frame.timeline->cameras()[frame.camera].model,
                                        frame.row.T_world_camera,
                                        frame.row.t_ns,
                                        renderer::PixelFormat::kGrey8);
}

CameraModel half_sized(const CameraModel& camera) {
  PinholeCamera half = camera.pinhole();
  half.width_px /= 2;
  half.height_px /= 2;
  half.fx_px *= 0.5;
  half.fy_px *= 0.5;
  // Pixel centres are at integers: the edge of the image, at -0.5, stays where it is.
  half.cx_px = 0.5 * (half.cx_px + 0.5) - 0.5;
  half.cy_px = 0.5 * (half.cy_px + 0.5) - 0.5;
  return {half, camera.distortion()};
}

const ScaledImage* FrameImages::find(const std::string& key) {
  const auto known =
      std::find_if(kept_.begin(), kept_.end(), [&](const Kept& kept) { return kept.key == key; });
  if (known == kept_.end()) return nullptr;
  kept_.splice(kept_.begin(), kept_, known);
  return &kept_.front().image;
}

void FrameImages::keep(const std::string& key, const ScaledImage& image) {
  kept_.push_front({key, image});
  kept_bytes_ += image.image->data.size();
  while (kept_bytes_ > kMostBytes && kept_.size() > kLeastKept) {
    kept_bytes_ -= kept_.back().image.image->data.size();
    kept_.pop_back();
  }
}

FrameImages::Made<FrameImages::SharedImage> FrameImages::received(const ViewedFrame& frame) {
  const std::string key = key_of("received", frame);
  if (const ScaledImage* known = find(key)) return std::optional(known->image);
  SharedImage image;
  const auto live = frame.timeline->live_camera(frame.camera);
  if (live && live->image && live->frame == frame.row.frame) {
    image = live->image;
  } else {
    const auto folder = runs_.folder(frame.run_id);
    if (!folder) return folder.error();
    const std::string name = frame.timeline->cameras()[frame.camera].name;
    const auto recorded = CameraFiles(*folder, frame.camera, name).image(frame.row.frame);
    std::error_code error;
    if (std::filesystem::is_regular_file(recorded, error)) {
      const auto bytes = read_file_bytes(recorded, kMostFileBytes);
      if (!bytes) return bytes.error();
      auto decoded = decode_jpeg(*bytes);
      if (!decoded) return decoded.error().in(recorded.string());
      image = std::make_shared<const Image>(std::move(*decoded));
    } else {
      const auto again = renderers_.frames_of(frame.run_id);
      if (!again) return again.error();
      if (!*again) return std::optional<SharedImage>();
      auto made = (*again)->maker.make(frame.camera, frame.row, (*again)->renderer);
      if (!made) return made.error();
      image = std::make_shared<const Image>(std::move(*made));
    }
  }
  keep(key, {image, {}});
  return std::optional(std::move(image));
}

void FrameImages::remember(const ViewedFrame& frame, const StampedImage& live) {
  ViewedFrame shown = frame;
  shown.row.frame = live.frame;
  const std::string key = key_of("received", shown);
  if (find(key) == nullptr) keep(key, {live.image, {}});
}

FrameImages::Made<FrameImages::SharedImage> FrameImages::preview(const ViewedFrame& frame) {
  if (find(key_of("received", frame)) != nullptr) return std::optional(SharedImage());
  const auto again = renderers_.frames_of(frame.run_id);
  if (!again) return again.error();
  if (!*again) return std::optional<SharedImage>();
  FrameRemaker& maker = (*again)->maker;
  if (!maker.is_as_rendered(frame.camera, frame.row)) return std::optional(SharedImage());
  auto request = drawn_request(frame, maker);
  if (!request) return request.error();
  request->camera = half_sized(request->camera);
  request->tile_wait_ns = kPreviewTileWaitNs;
  auto drawn = (*again)->renderer.render_camera(*request);
  if (!drawn) return drawn.error();
  return std::optional(std::make_shared<const Image>(std::move(drawn->image)));
}

FrameImages::Made<ScaledImage> FrameImages::depth(const ViewedFrame& frame, int max_width_px) {
  const auto again = renderers_.frames_of(frame.run_id);
  if (!again) return again.error();
  if (!*again) return std::optional<ScaledImage>();
  CameraModel camera = frame.timeline->cameras()[frame.camera].model;
  while (camera.pinhole().width_px > max_width_px && camera.pinhole().height_px > 1) {
    camera = half_sized(camera);
  }
  const std::string key = key_of("depth", frame, std::to_string(camera.pinhole().width_px));
  if (const ScaledImage* known = find(key)) return std::optional(*known);
  auto request = drawn_request(frame, (*again)->maker);
  if (!request) return request.error();
  request->camera = camera;
  const auto depth = (*again)->renderer.render_depth(*request);
  if (!depth) return depth.error();
  const ColourScale scale = depth_scale(*depth);
  const ScaledImage made{std::make_shared<const Image>(coloured_depth(*depth, scale)), scale};
  keep(key, made);
  return std::optional(made);
}

FrameImages::Made<renderer::SceneContent::Projection> FrameImages::projection(
    const ViewedFrame& frame) {
  constexpr int kMostWidthPx = 2048;
  constexpr int kMostDepthPx = 320;
  const std::string key = key_of("projection", frame);
  if (key == projected_key_) return std::optional(projected_);
  const Made<SharedImage> image = received(frame);
  if (!image) return image.error();
  const auto again = renderers_.frames_of(frame.run_id);
  if (!again) return again.error();
  if (!*image || !*again) return std::optional<renderer::SceneContent::Projection>();
  auto request = drawn_request(frame, (*again)->maker);
  if (!request) return request.error();
  renderer::SceneContent::Projection made;
  made.camera = request->camera;
  made.image = halved_to_fit(**image, kMostWidthPx);
  while (made.camera.pinhole().width_px > made.image->width_px) {
    made.camera = half_sized(made.camera);
  }
  if (made.camera.pinhole().width_px != made.image->width_px ||
      made.camera.pinhole().height_px != made.image->height_px) {
    return Error{ErrorCode::kConflict, "the camera's image does not have the size of its model"};
  }
  const int rows = request->camera.pinhole().height_px;
  made.T_world_camera_first = request->T_world_camera.at(request->row_time_ns(0.0));
  made.T_world_camera_last = request->T_world_camera.at(request->row_time_ns(rows - 1.0));
  while (request->camera.pinhole().width_px > kMostDepthPx) {
    request->camera = half_sized(request->camera);
  }
  auto depth = (*again)->renderer.render_depth(*request);
  if (!depth) return depth.error();
  made.depth = std::make_shared<const DepthImage>(std::move(*depth));
  projected_key_ = key;
  projected_ = made;
  return std::optional(std::move(made));
}

FrameImages::Made<FrameImages::SharedImage> FrameImages::ideal(const ViewedFrame& frame,
                                                               const Pose& T_world_camera) {
  const std::string key = key_of("ideal", frame, pose_key(T_world_camera));
  if (const ScaledImage* known = find(key)) return std::optional(known->image);
  const auto again = renderers_.frames_of(frame.run_id);
  if (!again) return again.error();
  if (!*again) return std::optional<SharedImage>();
  auto made =
      (*again)->maker.make_ideal(frame.camera, frame.row, T_world_camera, (*again)->renderer);
  if (!made) return made.error();
  const auto image = std::make_shared<const Image>(std::move(*made));
  keep(key, {image, {}});
  return std::optional<SharedImage>(image);
}

FrameImages::Made<FrameImages::SharedImage> FrameImages::from_estimate(const ViewedFrame& frame,
                                                                       const Pose& T_world_camera) {
  auto seen = ideal(frame, T_world_camera);
  if (!seen && seen.error().code == ErrorCode::kInvalidArgument) {
    return Error{ErrorCode::kNotFound, "no view from the estimated pose: " + seen.error().message};
  }
  return seen;
}

FrameImages::Made<FrameImages::Pair> FrameImages::compared(const ViewedFrame& frame,
                                                           const Comparison& comparison) {
  const auto& estimate = comparison.T_world_camera_estimate;
  auto a = estimate ? from_estimate(frame, *estimate) : received(frame);
  if (!a) return a.error();
  if (!*a) return std::optional<Pair>();
  auto b = ideal(frame, frame.row.T_world_camera);
  if (!b) return b.error();
  if (!*b) return std::optional<Pair>();
  const Image& first = ***a;
  const Image& second = ***b;
  if (first.width_px != second.width_px || first.height_px != second.height_px) {
    return Error{ErrorCode::kConflict,
                 "the camera's image has " + std::to_string(first.width_px) + " x " +
                     std::to_string(first.height_px) + " px, its model " +
                     std::to_string(second.width_px) + " x " + std::to_string(second.height_px)};
  }
  return std::optional(Pair{**a, **b});
}

FrameImages::Made<ScaledImage> FrameImages::difference(const ViewedFrame& frame,
                                                       const Comparison& comparison) {
  const auto& estimate = comparison.T_world_camera_estimate;
  const std::string key = key_of("difference", frame, estimate ? pose_key(*estimate) : "");
  if (const ScaledImage* known = find(key)) return std::optional(*known);
  const Made<Pair> pair = compared(frame, comparison);
  if (!pair) return pair.error();
  if (!*pair) return std::optional<ScaledImage>();
  const auto difference = grey_difference(*(*pair)->a, *(*pair)->b);
  const ColourScale scale = difference_scale(difference);
  const ScaledImage made{std::make_shared<const Image>(coloured_difference(difference, scale)),
                         scale};
  keep(key, made);
  return std::optional(made);
}

FrameImages::Made<int> FrameImages::difference_at(const ViewedFrame& frame,
                                                  const Comparison& comparison,
                                                  int x_px,
                                                  int y_px) {
  const Made<Pair> pair = compared(frame, comparison);
  if (!pair) return pair.error();
  if (!*pair) return std::optional<int>();
  const auto pixel = [&](const Image& image) {
    Image one(1, 1, image.channels);
    for (int c = 0; c < image.channels; ++c) one.at(0, 0, c) = image.at(x_px, y_px, c);
    return one;
  };
  const int value = grey_difference(pixel(*(*pair)->a), pixel(*(*pair)->b)).at(0, 0);
  return std::optional(value);
}

}  // namespace overfly::server
