#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

#include "server/net/http/error_response.hpp"
#include "server/net/http/json_text.hpp"
#include "server/net/rest/rest_api.hpp"
#include "server/net/stream/row_encoder.hpp"
#include "server/record/run_info.hpp"

namespace overfly::net {
namespace {

using nlohmann::json;
using server::RunManager;

constexpr std::size_t kMaxKeyBytes = 200;

struct StartBody {
  std::string scenario;
  std::vector<server::Override> overrides;
  std::optional<json> document;  ///< in place of scenario and overrides
};

Result<StartBody> parse_start(const std::string& text) {
  const Result<json> body = parse_object(text, "the body");
  if (!body) return body.error();
  JsonFields fields(*body, "");
  StartBody start;
  if (body->contains("document")) {
    for (const char* other : {"scenario", "overrides"}) {
      if (body->contains(other)) fields.reject(other, ": must not be given with document");
    }
    if (const json* document = fields.object("document")) start.document = *document;
    if (const Status status = fields.finish(); !status) return status.error();
    return start;
  }
  fields.require("scenario");
  start.scenario = fields.text("scenario").value_or("");
  if (const json* overrides = fields.object("overrides")) {
    for (const auto& [path, value] : overrides->items()) start.overrides.push_back({path, value});
  }
  if (const Status status = fields.finish(); !status) return status.error();
  return start;
}

/// The response for a run that was refused for lack of room or because of an invalid request.
HttpResponse start_refusal(const server::StartReport& report, const Error& error) {
  using Refusal = server::StartReport::Refusal;
  if (report.refusal == Refusal::kQueueFull) {
    return error_response(429, "queue_full", error.message);
  }
  if (report.refusal == Refusal::kKeyUsed) {
    return error_response(422, "idempotency_key_used", error.message);
  }
  if (report.refusal == Refusal::kMemory) {
    return error_response(422, "not_enough_memory", error.message);
  }
  return error_response(error);
}

Result<server::RunInfo> start_document(RunManager& runs,
                                       const json& document,
                                       const server::IdempotencyKey& key,
                                       server::StartReport* report) {
  Result<server::Scenario> scenario = runs.library().read_to_fly(document);
  if (!scenario) return scenario.error();
  return runs.start(std::move(*scenario), key, report);
}

HttpResponse start_run(RunManager* runs, const HttpRequest& request) {
  if (auto refused = not_json(request)) return std::move(*refused);
  const server::IdempotencyKey key{request.header("idempotency-key"),
                                   std::hash<std::string>()(request.body)};
  if (key.text.size() > kMaxKeyBytes) {
    return error_response(
        {ErrorCode::kInvalidArgument,
         "Idempotency-Key: must have at most " + std::to_string(kMaxKeyBytes) + " characters"});
  }
  const Result<StartBody> start = parse_start(request.body);
  if (!start) return error_response(start.error());
  server::StartReport report;
  const auto info = start->document ? start_document(*runs, *start->document, key, &report)
                                    : runs->start(start->scenario, start->overrides, key, &report);
  if (!info) return start_refusal(report, info.error());
  HttpResponse response = json_response(report.repeated ? 200 : 201, listed_run_json(*info));
  response.headers.emplace_back("Location", "/api/v1/runs/" + info->id);
  return response;
}

/// The list of runs as JSON text. The entry of an unchanged run is the same object as before, so
/// its text is cached. Thread-safe.
class RunListText {
 public:
  std::string of(const server::RunList& runs) {
    const std::lock_guard lock(mutex_);
    std::unordered_map<std::shared_ptr<const server::RunInfo>, std::string> kept;
    kept.reserve(runs.size());
    std::string text = R"({"runs":[)";
    for (const auto& info : runs) {
      const auto known = texts_.find(info);
      std::string own =
          known == texts_.end() ? to_text(listed_run_json(*info)) : std::move(known->second);
      if (!kept.empty()) text += ',';
      text += own;
      kept.emplace(info, std::move(own));
    }
    texts_ = std::move(kept);
    return text + "]}";
  }

 private:
  std::mutex mutex_;
  std::unordered_map<std::shared_ptr<const server::RunInfo>, std::string> texts_;
};

HttpResponse list_runs(RunManager* runs, RunListText& texts) {
  HttpResponse response = json_response(200, json());
  response.body = texts.of(runs->runs());
  return response;
}

HttpResponse one_run(RunManager* runs, const std::string& id, int status) {
  const auto info = runs->run(id);
  return info ? json_response(status, listed_run_json(*info)) : error_response(info.error());
}

Result<server::RunNotes> parse_notes(const std::string& text) {
  const Result<json> body = parse_object(text, "the body");
  if (!body) return body.error();
  JsonFields fields(*body, "");
  fields.require("tags");
  fields.require("note");
  server::RunNotes notes;
  notes.note = fields.text("note").value_or("");
  if (const json* tags = fields.array("tags")) {
    for (std::size_t i = 0; i < tags->size(); ++i) {
      if (!(*tags)[i].is_string()) {
        fields.reject("tags." + std::to_string(i), ": must be a text");
        break;
      }
      notes.tags.push_back((*tags)[i].get<std::string>());
    }
  }
  if (const Status status = fields.finish(); !status) return status.error();
  return notes;
}

HttpResponse set_notes(RunManager* runs, const std::string& id, const HttpRequest& request) {
  if (auto refused = not_json(request)) return std::move(*refused);
  const Result<server::RunNotes> notes = parse_notes(request.body);
  if (!notes) return error_response(notes.error());
  if (const Status status = runs->set_notes(id, *notes); !status) {
    return error_response(status.error());
  }
  return one_run(runs, id, 200);
}

}  // namespace

void add_run_routes(RestRouter* router, RunManager* runs, server::ViewService* views) {
  const auto texts = std::make_shared<RunListText>();
  router->add("GET", "/api/v1/runs", [runs, texts](const RouteCall&, const Respond& respond) {
    respond(list_runs(runs, *texts));
  });
  router->add("POST", "/api/v1/runs", [runs](const RouteCall& call, const Respond& respond) {
    respond(start_run(runs, call.request));
  });
  router->add("GET", "/api/v1/runs/{id}", [runs](const RouteCall& call, const Respond& respond) {
    respond(one_run(runs, call.path.at("id"), 200));
  });
  router->add(
      "POST", "/api/v1/runs/{id}/cancel", [runs](const RouteCall& call, const Respond& respond) {
        const Status status = runs->cancel(call.path.at("id"));
        respond(status ? one_run(runs, call.path.at("id"), 202) : error_response(status.error()));
      });
  router->add(
      "PUT", "/api/v1/runs/{id}/notes", [runs](const RouteCall& call, const Respond& respond) {
        respond(set_notes(runs, call.path.at("id"), call.request));
      });
  router->add(
      "DELETE", "/api/v1/runs/{id}", [runs, views](const RouteCall& call, const Respond& respond) {
        const Status status = runs->remove(call.path.at("id"));
        if (status) views->drop_deleted();
        HttpResponse gone;
        gone.status = 204;
        respond(status ? gone : error_response(status.error()));
      });
}

}  // namespace overfly::net
