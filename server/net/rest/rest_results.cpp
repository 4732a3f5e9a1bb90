#include <algorithm>
#include <system_error>
#include <utility>

#include "core/motion/trajectory_io.hpp"
#include "core/outside/file_text.hpp"
#include "server/net/http/error_response.hpp"
#include "server/net/rest/rest_api.hpp"
#include "server/net/stream/row_encoder.hpp"
#include "server/record/run_folder.hpp"
#include "server/scoring/metrics.hpp"
#include "server/scoring/run_metrics_json.hpp"
#include "server/timeline/row_alignment.hpp"
#include "server/timeline/run_timeline.hpp"

namespace overfly::net {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using server::RunManager;
using server::RunTimeline;

constexpr const char* kTruth = "truth";
constexpr const char* kTumType = "text/plain; charset=utf-8";

/// Whether a run's file is a symbolic link to a place outside the run's folder.
bool leads_out_of(const fs::path& folder, const fs::path& file) {
  std::error_code error;
  const fs::path place = fs::canonical(file, error);
  if (error) return false;  // reading it will report the error
  const fs::path home = fs::canonical(folder, error);
  const auto parts = std::mismatch(home.begin(), home.end(), place.begin(), place.end());
  return error || parts.first != home.end();
}

HttpResponse text_response(std::string text, const std::string& content_type) {
  HttpResponse response;
  response.content_type = content_type;
  response.headers.emplace_back("Cache-Control", "no-cache");
  response.body = std::move(text);
  return response;
}

/// Serves a file of a run unchanged. @param name  relative to the run's folder
HttpResponse result_response(const fs::path& folder,
                             const fs::path& name,
                             const std::string& content_type,
                             const std::string& absent) {
  constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 30U;
  const fs::path file = folder / name;
  if (leads_out_of(folder, file)) {
    return error_response(
        {ErrorCode::kIo,
         name.string() + ": is a symbolic link to a place outside the run's folder"});
  }
  Result<std::string> text = read_file_text(file, kMaxBytes);
  if (!text) {
    const ErrorCode code = text.error().code;
    if (code == ErrorCode::kIo) {
      return error_response({code, "cannot read " + file.filename().string()});
    }
    return error_response({ErrorCode::kNotFound, absent});
  }
  return text_response(std::move(*text), content_type);
}

HttpResponse metrics(RunManager* runs, const std::string& id) {
  const auto timeline = runs->timeline(id);
  if (!timeline) return error_response(timeline.error());
  if (const auto scored = (*timeline)->metrics()) {
    return json_response(200, server::json_from(*scored));
  }
  // A run plays without its metrics, also if they are damaged.
  const auto folder = runs->folder(id);
  const auto read = folder ? server::read_run_metrics(*folder) : folder.error();
  if (!read && read.error().code != ErrorCode::kNotFound) return error_response(read.error());
  return error_response({ErrorCode::kNotFound, "run " + id + " is not scored"});
}

HttpResponse estimators(RunManager* runs, const std::string& id) {
  const auto timeline = runs->timeline(id);
  if (!timeline) return error_response(timeline.error());
  return json_response(200, {{"estimators", estimator_statuses_json(**timeline)}});
}

HttpResponse manifest(RunManager* runs, const std::string& id) {
  const auto folder = runs->folder(id);
  if (!folder) return error_response(folder.error());
  return result_response(
      *folder, "manifest.json", "application/json", "run " + id + " has no manifest yet");
}

/// Rows 0 to count - 1, read in parts: a run that flies waits for each.
/// Errors: kUnsupported for more than are served at once.
template <typename Row, typename ReadRows>
Result<std::vector<Row>> all_rows(std::size_t count, const ReadRows& read_rows) {
  constexpr std::size_t kMostRows = 1'000'000;
  constexpr std::size_t kPart = 2000;
  if (count > kMostRows) {
    return Error{ErrorCode::kUnsupported,
                 "format = json: the trajectory has " + std::to_string(count) +
                     " rows: must have at most " + std::to_string(kMostRows) +
                     " (format=tum has no limit)"};
  }
  std::vector<Row> rows;
  rows.reserve(count);
  while (rows.size() < count) {
    std::vector<Row> part = read_rows(rows.size(), std::min(kPart, count - rows.size()));
    if (part.empty()) break;
    std::move(part.begin(), part.end(), std::back_inserter(rows));
  }
  return rows;
}

Result<json> columns_of(const RunTimeline& timeline,
                        const std::string& name,
                        const std::string& alignment) {
  if (name == kTruth) {
    const auto rows = all_rows<server::FrameRow>(
        timeline.frame_count(),
        [&](std::size_t first, std::size_t limit) { return timeline.frames(first, limit); });
    if (!rows) return rows.error();
    return truth_columns(*rows);
  }
  const auto& names = timeline.estimators();
  const auto index =
      static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  const auto placed = server::RowAlignment::of(timeline, index, alignment);
  if (!placed) return placed.error();
  const auto rows = all_rows<server::EstimateRow>(timeline.estimate_count(index),
                                                  [&](std::size_t first, std::size_t limit) {
                                                    return timeline.estimates(index, first, limit);
                                                  });
  if (!rows) return rows.error();
  return estimate_columns(timeline, index, *rows, *placed);
}

/// Checks the parameters `format` and `alignment` for the trajectory `name`.
Status check_trajectory_query(const RouteCall& call, const std::string& name) {
  const std::string format = call.query_or("format", "tum");
  if (format != "tum" && format != "json") {
    return Error{ErrorCode::kInvalidArgument,
                 "format = " + format + ": must be \"tum\" or \"json\""};
  }
  if (call.query.contains("alignment") && (format == "tum" || name == kTruth)) {
    return Error{
        ErrorCode::kInvalidArgument,
        "alignment = " + call.query.at("alignment") +
            ": applies only to an estimate with format=json (a TUM file has no alignment)"};
  }
  return {};
}

HttpResponse trajectory(RunManager* runs, const RouteCall& call) {
  const std::string& id = call.path.at("id");
  const std::string& name = call.path.at("name");
  if (const Status status = check_trajectory_query(call, name); !status) {
    return error_response(status.error());
  }
  const auto timeline = runs->timeline(id);
  if (!timeline) return error_response(timeline.error());
  const auto& names = (*timeline)->estimators();
  if (name != kTruth && std::find(names.begin(), names.end(), name) == names.end()) {
    return error_response({ErrorCode::kNotFound, "run " + id + " has no trajectory " + name});
  }
  if (call.query_or("format", "tum") == "json") {
    return json_or_error(
        columns_of(**timeline, name, call.query_or("alignment", server::kRecordedAlignment)));
  }
  const auto folder = runs->folder(id);
  if (!folder) return error_response(folder.error());
  const fs::path file = name == kTruth ? server::CameraFiles::of_main_camera(*folder).truth()
                                       : server::estimate_tum_file(*folder, name);
  std::error_code ignored;
  if (!fs::exists(fs::symlink_status(file, ignored))) {
    const auto made = server::missing_trajectory(*folder, file);
    if (made) return text_response(tum_text(made->poses, made->comments), kTumType);
    if (made.error().code != ErrorCode::kNotFound) return error_response(made.error());
  }
  return result_response(
      *folder,
      file.lexically_relative(*folder),
      kTumType,
      name + ".tum is written when the run ends; format=json returns the rows so far");
}

}  // namespace

void add_result_routes(RestRouter* router, RunManager* runs) {
  router->add(
      "GET", "/api/v1/runs/{id}/metrics", [runs](const RouteCall& call, const Respond& respond) {
        respond(metrics(runs, call.path.at("id")));
      });
  router->add(
      "GET", "/api/v1/runs/{id}/estimators", [runs](const RouteCall& call, const Respond& respond) {
        respond(estimators(runs, call.path.at("id")));
      });
  router->add(
      "GET", "/api/v1/runs/{id}/manifest", [runs](const RouteCall& call, const Respond& respond) {
        respond(manifest(runs, call.path.at("id")));
      });
  router->add(
      "GET", "/api/v1/runs/{id}/scenario", [runs](const RouteCall& call, const Respond& respond) {
        respond(json_or_error(runs->document_of(call.path.at("id"))));
      });
  router->add(
      "GET",
      "/api/v1/runs/{id}/trajectories/{name}",
      [runs](const RouteCall& call, const Respond& respond) { respond(trajectory(runs, call)); },
      {"format", "alignment"});
}

}  // namespace overfly::net
