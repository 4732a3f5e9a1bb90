#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/net/http/error_response.hpp"
#include "server/net/rest/rest_api.hpp"
#include "server/net/rest/rest_uploads.hpp"

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

Result<server::ResidualRequest> residual_request_of(const RouteCall& call) {
  const Result<server::SeriesRequest> series = series_request_of(call);
  if (!series) return series.error();
  server::ResidualRequest request;
  request.source = series->source;
  request.slice = series->slice;
  request.max_points = series->max_points;
  const std::string offset = call.query_or("time_offset_s", "0");
  if (offset == "auto") {
    request.time_offset_s.reset();
    return request;
  }
  constexpr double kMost = flight::smoothing::kMaxTimeOffsetS;
  request.time_offset_s = number_from<double>(offset);
  if (!request.time_offset_s || !(std::abs(*request.time_offset_s) <= kMost)) {
    return bad_query("time_offset_s", offset, "auto or a time in [-2, 2] s");
  }
  return request;
}

void answer_residuals(const LogRoutes& routes, const RouteCall& call, const Respond& respond) {
  const auto request = residual_request_of(call);
  if (!request) {
    respond(error_response(request.error()));
    return;
  }
  // On the board as long as the work below exists.
  std::shared_ptr<ProgressBoard::Entry> entry;
  if (const std::string id = call.query_or("progress", ""); !id.empty()) {
    if (!is_progress_id(id)) {
      respond(error_response(
          bad_query("progress", id, "8 to 64 letters, digits and '-', of the client's choice")));
      return;
    }
    entry = ProgressBoard::begin(routes.progress, id);
  }
  read_and_answer(routes.readers,
                  "a flight log",
                  call,
                  respond,
                  [library = routes.logs, name = call.path.at("name"), request = *request, entry](
                      const std::atomic<bool>* cancel) {
                    flight::smoothing::SmoothingProgress progress;
                    if (entry) {
                      entry->set("reading", 0.0);
                      progress = [&](const std::string& step, double share) {
                        entry->set(step, share);
                      };
                    }
                    Result<json> residuals = library->residuals(name, request, cancel, progress);
                    // Before the answer: copies of this function may live longer.
                    if (entry) entry->end();
                    return residuals;
                  });
}

/// The parameter `files`: "NAME:SIZE,NAME:SIZE". Errors: kInvalidArgument.
Result<std::vector<server::UploadFile>> upload_files_of(const std::string& text) {
  std::vector<server::UploadFile> files;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string entry = text.substr(begin, end - begin);
    const std::size_t colon = entry.find(':');
    const auto size = colon == std::string::npos
                          ? std::nullopt
                          : number_from<std::uint64_t>(entry.substr(colon + 1));
    if (!size || files.size() >= server::kMaxUploadFiles) {
      return bad_query("files",
                       text,
                       "NAME:BYTES of each file, separated by commas, at most " +
                           std::to_string(server::kMaxUploadFiles));
    }
    files.push_back({entry.substr(0, colon), *size});
    begin = end + 1;
  }
  return files;
}

/// Begins the upload that a request announces: of one log, or of several files.
Result<std::unique_ptr<server::LogUpload>> begin_upload(const server::LogUploads& uploads,
                                                        const RouteCall& call,
                                                        std::optional<std::uint64_t> size_bytes,
                                                        UploadRefusal& refusal) {
  const auto found = call.query.find("files");
  if (found == call.query.end()) {
    return uploads.begin(call.query_or("name", ""), size_bytes, refusal, server::log_upload_kind());
  }
  if (call.query.contains("name")) {
    return bad_query("name", call.query.at("name"), "absent where query.files is given");
  }
  const auto files = upload_files_of(found->second);
  if (!files) return files.error();
  return uploads.begin_set(*files, refusal);
}

}  // namespace

void add_log_routes(RestRouter* router, const LogRoutes& routes) {
  LogLibrary* const logs = routes.logs;
  router->add("GET", "/api/v1/logs", [logs](const RouteCall&, const Respond& respond) {
    respond(json_response(200, logs->list()));
  });
  router->add_upload(
      "/api/v1/logs",
      [logs](const RouteCall& call,
             std::optional<std::uint64_t> size_bytes,
             std::optional<HttpResponse>* answer) -> std::unique_ptr<BodySink> {
        UploadRefusal refusal = UploadRefusal::kNone;
        auto upload = begin_upload(logs->uploads(), call, size_bytes, refusal);
        if (upload) {
          return upload_sink(
              std::move(*upload),
              [logs](const std::filesystem::path& file) { return logs->entry_of(file); },
              "/api/v1/logs/");
        }
        *answer = upload_refused(refusal, upload.error());
        return nullptr;
      },
      {"name", "files"});
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
  router->add("GET",
              "/api/v1/logs/{name}/residuals",
              [routes](const RouteCall& call, const Respond& respond) {
                answer_residuals(routes, call, respond);
              },
              {"source", "from_s", "to_s", "points", "time_offset_s", "progress"});
  router->add(
      "DELETE", "/api/v1/logs/{name}", [logs](const RouteCall& call, const Respond& respond) {
        respond(removed_response(logs->remove(call.path.at("name"))));
      });
}

}  // namespace overfly::net
