#include <charconv>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "core/barrier.hpp"
#include "core/time.hpp"
#include "server/net/http/error_response.hpp"
#include "server/net/rest/rest_api.hpp"

namespace overfly::net {
namespace {

using nlohmann::json;
using server::LogLibrary;
using server::UploadRefusal;

/// Times of ROS count from 1970.
constexpr double kLatestS = 9e9;

Error bad_query(const std::string& name, const std::string& text, const std::string& limit) {
  constexpr std::size_t kShown = 100;
  return {ErrorCode::kInvalidArgument,
          "query." + name + " = " + text.substr(0, kShown) + ": must be " + limit};
}

template <typename Number>
std::optional<Number> number_from(const std::string& text) {
  Number number{};
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || rest != end) return std::nullopt;
  return number;
}

Status read_time(const RouteCall& call, const std::string& name, std::optional<std::int64_t>& t) {
  const auto found = call.query.find(name);
  if (found == call.query.end()) return {};
  const auto time_s = number_from<double>(found->second);
  // Written so that not-a-number is rejected as well.
  if (!time_s || !(*time_s >= 0.0 && *time_s <= kLatestS)) {
    return bad_query(name, found->second, "a time in [0, 9e9] s");
  }
  t = ns_from_s(*time_s);
  return {};
}

Result<flight::logs::LogSlice> slice_of(const RouteCall& call) {
  flight::logs::LogSlice slice;
  if (Status status = read_time(call, "from_s", slice.from_ns); !status) return status.error();
  if (Status status = read_time(call, "to_s", slice.to_ns); !status) return status.error();
  if (slice.from_ns && slice.to_ns && *slice.from_ns > *slice.to_ns) {
    return bad_query("to_s", call.query.at("to_s"), "no earlier than query.from_s");
  }
  return slice;
}

Result<server::SeriesRequest> series_request_of(const RouteCall& call) {
  server::SeriesRequest request;
  Result<flight::logs::LogSlice> slice = slice_of(call);
  if (!slice) return slice.error();
  request.slice = *slice;
  request.source = call.query_or("source", "");
  const auto found = call.query.find("points");
  if (found == call.query.end()) return request;
  const auto points = number_from<std::size_t>(found->second);
  if (!points || *points < server::kMinSeriesPoints || *points > server::kMaxSeriesPoints) {
    return bad_query("points",
                     found->second,
                     "a whole number in [" + std::to_string(server::kMinSeriesPoints) + ", " +
                         std::to_string(server::kMaxSeriesPoints) + "]");
  }
  request.max_points = *points;
  return request;
}

HttpResponse answer_of(const Result<json>& result) {
  if (result) return json_response(200, *result);
  // The log is the client's choice: that it cannot be read is no failure of the server.
  if (result.error().code == ErrorCode::kUnreadable) {
    return error_response(422, "unreadable", result.error().message);
  }
  return error_response(result.error());
}

/// Reads on a thread for logs and answers from there.
void read_and_answer(const LogRoutes& routes,
                     const RouteCall& call,
                     const Respond& respond,
                     std::function<Result<json>(const std::atomic<bool>*)> read) {
  const auto work = [report = routes.report,
                     respond,
                     abandoned = call.request.abandoned,
                     read = std::move(read)] {
    if (abandoned && *abandoned) {
      respond(error_response({ErrorCode::kCancelled, "the client has gone"}));
      return;
    }
    (void)contained([&] { respond(answer_of(read(abandoned.get()))); },
                    [&](const char* what) {
                      report(std::string("reading a flight log failed: ") + what);
                      respond(error_response({ErrorCode::kInternal,
                                              "internal error: the server's log has the reason"}));
                    });
  };
  const bool taken = routes.read(work, call.request.abandoned);
  if (!taken) {
    respond(error_response(
        503, "too_many_readers", "too many flight logs are being read: try again soon"));
  }
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
            routes,
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
                read_and_answer(routes,
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
