#include <algorithm>
#include <atomic>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/motion/pose.hpp"
#include "server/net/http/error_response.hpp"
#include "server/net/rest/rest_api.hpp"
#include "server/net/rest/rest_reading.hpp"
#include "server/net/stream/run_instant.hpp"
#include "server/timeline/run_timeline.hpp"
#include "server/views/picture_request.hpp"

namespace overfly::net {
namespace {

using server::Picture;
using server::PictureRequest;

/// First client number for single requests; lower numbers belong to WebSocket connections.
constexpr std::uint64_t kFirstRequestClient = std::uint64_t{1} << 63U;
constexpr int kFullWidth = 1 << 14;
constexpr int kQuality = 90;

/// The frame number in "17.jpg".
std::optional<std::int64_t> frame_of(const std::string& file_name) {
  std::int64_t frame = 0;
  const char* end = file_name.data() + file_name.size();
  const auto [rest, error] = std::from_chars(file_name.data(), end, frame);
  if (error != std::errc() || frame < 0) return std::nullopt;
  return std::string(rest, end) == ".jpg" ? std::optional<std::int64_t>(frame) : std::nullopt;
}

/// Stamp of exactly this frame.
std::optional<std::int64_t> stamp_of(const server::RunTimeline& timeline, std::int64_t frame) {
  const auto t_ns = time_of_frame(timeline, frame);
  const auto row = t_ns ? timeline.frame_at(*t_ns) : std::nullopt;
  return row && row->frame == frame ? t_ns : std::nullopt;
}

HttpResponse picture_response(const Result<Picture>& picture) {
  if (!picture) return error_response(picture.error());
  HttpResponse response;
  response.content_type = "image/jpeg";
  response.headers.emplace_back("Cache-Control", "no-cache");
  response.body.assign(picture->bytes->begin(), picture->bytes->end());
  return response;
}

/// Index of an estimator of the run. Errors: kNotFound naming it.
Result<std::size_t> estimator_index(const server::RunTimeline& timeline, const std::string& name) {
  const auto& names = timeline.estimators();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    return Error{ErrorCode::kNotFound, "the run has no estimator " + name};
  }
  return static_cast<std::size_t>(found - names.begin());
}

Result<double> pixel_of(const RouteCall& call, const char* name) {
  const std::string text = call.query_or(name, "");
  const auto value = number_from<double>(text);
  if (value && std::isfinite(*value)) return *value;
  return bad_query(name, text, "a number of pixels");
}

/// The request without run and time.
Result<server::PixelRequest> pixel_request(const RouteCall& call,
                                           const server::RunTimeline& timeline) {
  server::PixelRequest request;
  request.camera = call.query_or("camera", "");
  request.alignment = call.query_or("alignment", server::kRecordedAlignment);
  const Result<double> x_px = pixel_of(call, "x_px");
  if (!x_px) return x_px.error();
  const Result<double> y_px = pixel_of(call, "y_px");
  if (!y_px) return y_px.error();
  request.x_px = *x_px;
  request.y_px = *y_px;
  const std::string picture = call.query_or("picture", "camera");
  const std::string of_estimator = "error/";
  if (picture == "error") {
    request.error.emplace();
  } else if (picture.starts_with(of_estimator)) {
    const auto index = estimator_index(timeline, picture.substr(of_estimator.size()));
    if (!index) return index.error();
    request.error = server::ErrorOf{*index};
  } else if (picture != "camera" && picture != "depth") {
    return Error{ErrorCode::kInvalidArgument,
                 "picture = " + picture + ": must be camera, depth, error or error/NAME"};
  }
  return request;
}

nlohmann::json pixel_json(const server::PixelValue& value) {
  nlohmann::json pixel = {{"frame", value.frame},
                          {"t_ns", value.t_ns},
                          {"camera", value.camera},
                          {"width_px", value.width_px},
                          {"height_px", value.height_px},
                          {"grey", value.grey},
                          {"rgb", nullptr},
                          {"difference", nullptr},
                          {"ground", nullptr},
                          {"depth_m", nullptr},
                          {"range_m", nullptr}};
  if (value.rgb) pixel["rgb"] = *value.rgb;
  if (value.difference) pixel["difference"] = *value.difference;
  if (value.ground && value.ground_world_m) {
    const Eigen::Vector3d& place = *value.ground_world_m;
    pixel["ground"] = {{"lat_deg", deg_from_rad(value.ground->lat_rad)},
                       {"lon_deg", deg_from_rad(value.ground->lon_rad)},
                       {"alt_ellipsoid_m", value.ground->alt_ellipsoid_m},
                       {"x_m", place.x()},
                       {"y_m", place.y()},
                       {"z_m", place.z()}};
    pixel["depth_m"] = value.depth_m;
    pixel["range_m"] = value.range_m;
  }
  return pixel;
}

/// What a route of a frame needs to ask for pictures.
struct FrameRoutes {
  server::RunManager* runs;
  server::ViewService* views;
  std::shared_ptr<std::atomic<std::uint64_t>> next_client =
      std::make_shared<std::atomic<std::uint64_t>>(kFirstRequestClient);
};

void answer_pixel(const FrameRoutes& routes, const RouteCall& call, const Respond& respond) {
  const std::string& id = call.path.at("id");
  const auto timeline = routes.runs->timeline(id);
  if (!timeline) {
    respond(error_response(timeline.error()));
    return;
  }
  const auto frame = number_from<std::int64_t>(call.path.at("file"));
  const auto t_ns = frame ? stamp_of(**timeline, *frame) : std::nullopt;
  if (!t_ns) {
    respond(error_response(
        {ErrorCode::kNotFound, "run " + id + " has no frame " + call.path.at("file")}));
    return;
  }
  Result<server::PixelRequest> request = pixel_request(call, **timeline);
  if (!request) {
    respond(error_response(request.error()));
    return;
  }
  request->run_id = id;
  request->t_ns = *t_ns;
  routes.views->probe(
      (*routes.next_client)++,
      0,
      *request,
      [respond](const Result<server::PixelValue>& value) {
        respond(value ? json_response(200, pixel_json(*value)) : error_response(value.error()));
      },
      call.request.abandoned);
}

void answer_frame(const FrameRoutes& routes, const RouteCall& call, const Respond& respond) {
  const std::string& id = call.path.at("id");
  const std::string& file = call.path.at("file");
  const auto timeline = routes.runs->timeline(id);
  if (!timeline) {
    respond(error_response(timeline.error()));
    return;
  }
  const auto frame = frame_of(file);
  const auto t_ns = frame ? stamp_of(**timeline, *frame) : std::nullopt;
  if (!t_ns) {
    respond(error_response({ErrorCode::kNotFound, "run " + id + " has no frame " + file}));
    return;
  }
  PictureRequest request;
  request.run_id = id;
  request.t_ns = *t_ns;
  request.quality = kQuality;
  request.max_width_px = kFullWidth;
  request.camera = call.query_or("camera", "");
  routes.views->request(
      (*routes.next_client)++,
      0,
      request,
      [respond](const Result<Picture>& picture) { respond(picture_response(picture)); },
      call.request.abandoned);
}

}  // namespace

void add_frame_routes(RestRouter* router, server::RunManager* runs, server::ViewService* views) {
  const FrameRoutes routes{runs, views};
  router->add("GET",
              "/api/v1/runs/{id}/frames/{file}",
              [routes](const RouteCall& call, const Respond& respond) {
                answer_frame(routes, call, respond);
              },
              {"camera"});
  router->add("GET",
              "/api/v1/runs/{id}/frames/{file}/pixel",
              [routes](const RouteCall& call, const Respond& respond) {
                answer_pixel(routes, call, respond);
              },
              {"x_px", "y_px", "camera", "picture", "alignment"});
}

}  // namespace overfly::net
