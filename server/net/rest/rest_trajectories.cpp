#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/evaluation.hpp"
#include "server/net/http/error_response.hpp"
#include "server/net/http/json_text.hpp"
#include "server/net/rest/rest_api.hpp"
#include "server/net/rest/rest_uploads.hpp"

namespace overfly::net {
namespace {

using nlohmann::json;
using server::EvaluationRequest;
using server::TrajectoryLibrary;
using server::UploadRefusal;

constexpr std::size_t kUsualTrajectoryPoints = 6000;

/// The texts of an array; empty with an error in `fields` if there are none or too many.
std::vector<std::string> texts_of(JsonFields& fields, const std::string& name, std::size_t most) {
  std::vector<std::string> texts;
  const json* const array = fields.array(name);
  if (array == nullptr) return texts;
  const std::string limit = ": must be 1 to " + std::to_string(most) + " texts";
  if (array->empty() || array->size() > most) fields.reject(name, limit);
  for (const json& entry : *array) {
    if (!entry.is_string() || texts.size() == most) {
      fields.reject(name, limit);
      break;
    }
    texts.push_back(entry.get<std::string>());
  }
  return texts;
}

void read_alignments(JsonFields& fields, EvaluationRequest& request) {
  const auto& all = evaluation::all_alignment_modes();
  for (const std::string& name : texts_of(fields, "alignments", all.size())) {
    const auto mode = evaluation::alignment_mode_from(name);
    if (name == "all") {
      request.score.alignments = all;
      return;
    }
    if (!mode) fields.reject("alignments", ": must be names of alignments, or \"all\"");
    if (mode) request.score.alignments.push_back(*mode);
  }
  if (request.score.alignments.empty()) {
    request.score.alignments = {evaluation::AlignmentMode::kInitScale};
  }
}

Result<EvaluationRequest> evaluation_request_from(const std::string& body) {
  const Result<json> object = parse_object(body, "an evaluation");
  if (!object) return object.error();
  EvaluationRequest request;
  JsonFields fields(*object, "");
  fields.require("truth");
  fields.require("estimates");
  request.truth = fields.text("truth").value_or("");
  request.estimates = texts_of(fields, "estimates", server::kMaxEvaluated);
  read_alignments(fields, request);
  request.association = fields.text("association").value_or(request.association);
  if (request.association == "nearest") {
    request.score.association = evaluation::Association::kNearest;
  } else if (request.association == "index") {
    request.score.association = evaluation::Association::kIndex;
  } else if (request.association != "interpolate") {
    fields.reject("association", ": must be interpolate, nearest or index");
  }
  if (const auto limit_ms = fields.number("max_time_difference_ms", 0.0, 1e9)) {
    request.score.max_time_difference_ns = static_cast<std::int64_t>(*limit_ms * 1e6);
  }
  request.score.init_true_depth_m = fields.number("init_true_depth_m", 1e-6, 1e9);
  if (const auto points = fields.integer("points",
                                         static_cast<std::int64_t>(server::kMinSeriesPoints),
                                         static_cast<std::int64_t>(server::kMaxSeriesPoints))) {
    request.points = static_cast<std::size_t>(*points);
  }
  request.score.find_offsets = fields.boolean("find_offsets").value_or(false);
  if (const Status status = fields.finish(); !status) return status.error();
  return request;
}

void answer_series(TrajectoryLibrary* library,
                   const ReadingRoutes& readers,
                   const RouteCall& call,
                   const Respond& respond) {
  const Result<std::size_t> points = points_query_of(
      call, kUsualTrajectoryPoints, server::kMinSeriesPoints, server::kMaxSeriesPoints);
  if (!points) {
    respond(error_response(points.error()));
    return;
  }
  read_and_answer(
      readers,
      "a trajectory",
      call,
      respond,
      [library, name = call.path.at("name"), most = *points](const std::atomic<bool>* cancel) {
        return library->series(name, most, cancel);
      });
}

void answer_evaluation(TrajectoryLibrary* library,
                       const ReadingRoutes& readers,
                       const RouteCall& call,
                       const Respond& respond) {
  const auto request = evaluation_request_from(call.request.body);
  if (!request) {
    respond(error_response(request.error()));
    return;
  }
  read_and_answer(readers,
                  "trajectories",
                  call,
                  respond,
                  [library, wanted = *request](const std::atomic<bool>* cancel) {
                    return library->evaluate(wanted, cancel);
                  });
}

}  // namespace

void add_trajectory_routes(RestRouter* router,
                           TrajectoryLibrary* library,
                           const ReadingRoutes& readers) {
  router->add("GET", "/api/v1/trajectories", [library](const RouteCall&, const Respond& respond) {
    respond(json_response(200, library->list()));
  });
  router->add_upload(
      "/api/v1/trajectories",
      [library](const RouteCall& call,
                std::optional<std::uint64_t> size_bytes,
                std::optional<HttpResponse>* answer) -> std::unique_ptr<BodySink> {
        UploadRefusal refusal = UploadRefusal::kNone;
        auto upload = library->uploads().begin(
            call.query_or("name", ""), size_bytes, refusal, server::trajectory_upload_kind());
        if (upload) {
          return upload_sink(
              std::move(*upload),
              [library](const std::filesystem::path& file) { return library->entry_of(file); },
              "/api/v1/trajectories/");
        }
        *answer = upload_refused(refusal, upload.error());
        return nullptr;
      },
      {"name"});
  router->add("DELETE",
              "/api/v1/trajectories/{name}",
              [library](const RouteCall& call, const Respond& respond) {
                respond(removed_response(library->remove(call.path.at("name"))));
              });
  router->add("GET",
              "/api/v1/trajectories/{name}/series",
              [library, readers](const RouteCall& call, const Respond& respond) {
                answer_series(library, readers, call, respond);
              },
              {"points"});
  router->add_long_calculation("/api/v1/evaluations",
                               [library, readers](const RouteCall& call, const Respond& respond) {
                                 answer_evaluation(library, readers, call, respond);
                               });
}

}  // namespace overfly::net
