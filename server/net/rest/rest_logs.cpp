#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "server/net/http/error_response.hpp"
#include "server/net/rest/rest_api.hpp"

namespace overfly::net {
namespace {

using nlohmann::json;
using server::LogLibrary;
using server::UploadRefusal;

Result<flight::logs::LogSlice> slice_of(const RouteCall& call) {
  const Result<TimeQuery> times = time_query_of(call);
  if (!times) return times.error();
  flight::logs::LogSlice slice;
  slice.from_ns = times->from_ns;
  slice.to_ns = times->to_ns;
  return slice;
}

Result<server::SeriesRequest> series_request_of(const RouteCall& call) {
  server::SeriesRequest request;
  Result<flight::logs::LogSlice> slice = slice_of(call);
  if (!slice) return slice.error();
  request.slice = *slice;
  request.source = call.query_or("source", "");
  const Result<std::size_t> points =
      points_query_of(call, request.max_points, server::kMinSeriesPoints, server::kMaxSeriesPoints);
  if (!points) return points.error();
  request.max_points = *points;
  return request;
}

HttpResponse upload_refused(UploadRefusal refusal, const Error& error) {
  switch (refusal) {
    case UploadRefusal::kNone:
      break;
    case UploadRefusal::kOff:
      return error_response(403, "forbidden", error.message);
    case UploadRefusal::kBusy:
      return error_response(503, "too_many_uploads", error.message);
    case UploadRefusal::kTooLarge:
      return error_response(413, "payload_too_large", error.message);
    case UploadRefusal::kQuota:
      return error_response(507, "quota_exceeded", error.message);
    case UploadRefusal::kNotALog:
      return error_response(422, "unreadable", error.message);
  }
  return error_response(error);
}

/// An upload as the body of a request.
class UploadSink final : public BodySink {
 public:
  UploadSink(std::unique_ptr<server::LogUpload> upload, const LogLibrary& logs)
      : upload_(std::move(upload)), logs_(logs) {}

  [[nodiscard]] std::optional<HttpResponse> write(std::span<const std::uint8_t> bytes) override {
    const Status written = upload_->write(bytes);
    if (written) return std::nullopt;
    return upload_refused(upload_->refusal(), written.error());
  }
  [[nodiscard]] HttpResponse finish() override {
    const auto file = upload_->finish();
    if (!file) return upload_refused(upload_->refusal(), file.error());
    HttpResponse response = json_response(201, logs_.entry_of(*file));
    response.headers.emplace_back(
        "Location",
        std::string("/api/v1/logs/") + server::kUploadsLabel + "%2F" + file->filename().string());
    return response;
  }

 private:
  std::unique_ptr<server::LogUpload> upload_;
  const LogLibrary& logs_;
};

}  // namespace

void add_log_routes(RestRouter* router, const LogRoutes& routes) {
  LogLibrary* const logs = routes.logs;
  router->add("GET", "/api/v1/logs", [logs](const RouteCall&, const Respond& respond) {
    respond(json_response(200, logs->list()));
  });
  router->add_upload("/api/v1/logs",
                     [logs](const RouteCall& call,
                            std::optional<std::uint64_t> size_bytes,
                            std::optional<HttpResponse>* answer) -> std::unique_ptr<BodySink> {
                       UploadRefusal refusal = UploadRefusal::kNone;
                       auto upload =
                           logs->uploads().begin(call.query_or("name", ""), size_bytes, refusal);
                       if (upload) return std::make_unique<UploadSink>(std::move(*upload), *logs);
                       *answer = upload_refused(refusal, upload.error());
                       return nullptr;
                     },
                     {"name"});
  router->add(
      "GET",
      "/api/v1/logs/{name}",
      [routes](const RouteCall& call, const Respond& respond) {
        const auto slice = slice_of(call);
        if (!slice) {
          respond(error_response(slice.error()));
          return;
        }
        read_and_answer(
            routes.readers,
            "a flight log",
            call,
            respond,
            [library = routes.logs, name = call.path.at("name"), slice = *slice](
                const std::atomic<bool>* cancel) { return library->info(name, slice, cancel); });
      },
      {"from_s", "to_s"});
  router->add("GET",
              "/api/v1/logs/{name}/series",
              [routes](const RouteCall& call, const Respond& respond) {
                const auto request = series_request_of(call);
                if (!request) {
                  respond(error_response(request.error()));
                  return;
                }
                read_and_answer(routes.readers,
                                "a flight log",
                                call,
                                respond,
                                [library = routes.logs,
                                 name = call.path.at("name"),
                                 request = *request](const std::atomic<bool>* cancel) {
                                  return library->series(name, request, cancel);
                                });
              },
              {"source", "from_s", "to_s", "points"});
  router->add(
      "DELETE", "/api/v1/logs/{name}", [logs](const RouteCall& call, const Respond& respond) {
        const Status removed = logs->remove(call.path.at("name"));
        if (!removed) {
          const bool foreign = removed.error().code == ErrorCode::kInvalidArgument;
          respond(foreign ? error_response(403, "forbidden", removed.error().message)
                          : error_response(removed.error()));
          return;
        }
        HttpResponse response;
        response.status = 204;
        respond(response);
      });
}

}  // namespace overfly::net
