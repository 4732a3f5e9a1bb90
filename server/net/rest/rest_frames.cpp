#include <atomic>
#include <charconv>
#include <optional>

#include "server/net/http/error_response.hpp"
#include "server/net/rest/rest_api.hpp"
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
  response.body.assign(picture->jpeg->begin(), picture->jpeg->end());
  return response;
}

}  // namespace

void add_frame_routes(RestRouter* router, server::RunManager* runs, server::ViewService* views) {
  const auto next_client = std::make_shared<std::atomic<std::uint64_t>>(kFirstRequestClient);
  const auto handler = [runs, views, next_client](const RouteCall& call, const Respond& respond) {
    const std::string& id = call.path.at("id");
    const std::string& file = call.path.at("file");
    const auto timeline = runs->timeline(id);
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
    views->request((*next_client)++, 0, request, [respond](const Result<Picture>& picture) {
      respond(picture_response(picture));
    });
  };
  router->add("GET", "/api/v1/runs/{id}/frames/{file}", handler, {"camera"});
}

}  // namespace overfly::net
