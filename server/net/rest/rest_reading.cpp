#include "server/net/rest/rest_reading.hpp"

#include <algorithm>
#include <utility>

#include "core/barrier.hpp"
#include "core/text/lower_case.hpp"
#include "core/time.hpp"
#include "server/net/http/error_response.hpp"

namespace overfly::net {
namespace {

using nlohmann::json;

/// Times of ROS count from 1970.
constexpr double kLatestS = 9e9;

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

HttpResponse answer_of(Result<HttpResponse> result) {
  return result ? std::move(*result) : error_response(result.error());
}

}  // namespace

std::optional<HttpResponse> not_json(const HttpRequest& request) {
  // The case of a media type has no meaning; blanks may stand before its parameters (RFC 9110,
  // sections 8.3.1 and 5.6.6).
  std::string type = lower_case(request.header("content-type"));
  type = type.substr(0, type.find_first_of("; \t"));
  if (type == "application/json") return std::nullopt;
  return error_response(415, "unsupported_media_type", "the body must be application/json");
}

HttpResponse page_response(std::string html) {
  HttpResponse response;
  response.status = 200;
  response.content_type = "text/html; charset=utf-8";
  response.headers.emplace_back("Content-Security-Policy",
                                "sandbox; default-src 'none'; img-src data:; style-src "
                                "'unsafe-inline'; frame-ancestors 'self'; form-action 'none'; "
                                "base-uri 'none'");
  response.headers.emplace_back("Cache-Control", "no-cache");
  response.body = std::move(html);
  return response;
}

void read_and_answer(const ReadingRoutes& routes,
                     const std::string& what,
                     const RouteCall& call,
                     const Respond& respond,
                     std::function<Result<json>(const std::atomic<bool>*)> read) {
  respond_from_reader(
      routes,
      what,
      call,
      respond,
      [read = std::move(read)](const std::atomic<bool>* cancel) -> Result<HttpResponse> {
        const Result<json> result = read(cancel);
        if (!result) return result.error();
        return json_response(200, *result);
      });
}

void respond_from_reader(const ReadingRoutes& routes,
                         const std::string& what,
                         const RouteCall& call,
                         const Respond& respond,
                         std::function<Result<HttpResponse>(const std::atomic<bool>*)> read) {
  const auto work = [report = routes.report,
                     what,
                     respond,
                     abandoned = call.request.abandoned,
                     read = std::move(read)] {
    if (abandoned && *abandoned) {
      respond(error_response({ErrorCode::kCancelled, "the client has gone"}));
      return;
    }
    (void)contained([&] { respond(answer_of(read(abandoned.get()))); },
                    [&](const char* reason) {
                      report("reading " + what + " failed: " + reason);
                      respond(internal_error_response());
                    });
  };
  const bool taken = routes.read(work, call.request.abandoned);
  if (!taken) {
    respond(error_response(503, "too_many_readers", "too much is being read: try again soon"));
  }
}

Error bad_query(const std::string& name, const std::string& text, const std::string& limit) {
  constexpr std::size_t kShown = 100;
  return {ErrorCode::kInvalidArgument,
          "query." + name + " = " + text.substr(0, kShown) + ": must be " + limit};
}

Result<std::vector<std::string>> run_ids_query_of(const RouteCall& call,
                                                  std::size_t min,
                                                  std::size_t max) {
  const std::string list = call.query_or("runs", "");
  std::vector<std::string> ids;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    ids.push_back(list.substr(begin, end - begin));
    begin = end + 1;
  }
  const bool empty = std::find(ids.begin(), ids.end(), "") != ids.end();
  if (empty || ids.size() < min || ids.size() > max) {
    return bad_query(
        "runs",
        list,
        std::to_string(min) + " to " + std::to_string(max) + " ids with commas between");
  }
  return ids;
}

Result<TimeQuery> time_query_of(const RouteCall& call) {
  TimeQuery times;
  if (Status status = read_time(call, "from_s", times.from_ns); !status) return status.error();
  if (Status status = read_time(call, "to_s", times.to_ns); !status) return status.error();
  if (times.from_ns && times.to_ns && *times.from_ns > *times.to_ns) {
    return bad_query("to_s", call.query.at("to_s"), "no earlier than query.from_s");
  }
  return times;
}

Result<std::size_t> points_query_of(const RouteCall& call,
                                    std::size_t absent,
                                    std::size_t min,
                                    std::size_t max) {
  const auto found = call.query.find("points");
  if (found == call.query.end()) return absent;
  const auto points = number_from<std::size_t>(found->second);
  if (!points || *points < min || *points > max) {
    return bad_query(
        "points",
        found->second,
        "a whole number in [" + std::to_string(min) + ", " + std::to_string(max) + "]");
  }
  return *points;
}

}  // namespace overfly::net
