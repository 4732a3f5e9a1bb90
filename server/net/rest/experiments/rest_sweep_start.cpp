// Starting, continuing and cancelling sweeps.
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "server/experiments/service/sweep_files.hpp"
#include "server/net/http/error_response.hpp"
#include "server/net/http/json_text.hpp"
#include "server/net/http/rest_slots.hpp"
#include "server/net/rest/rest_api.hpp"

namespace overfly::net {
namespace {

namespace experiments = server::experiments;
using experiments::SweepRefusal;
using experiments::SweepService;
using nlohmann::json;
using Cancel = const std::atomic<bool>*;

/// Which fields a request has.
enum class Asks { kStart, kContinue, kCheck };

struct SweepBody {
  std::string name;
  std::string file;  ///< a sweep file of the server; empty: the document
  experiments::SweepRequest request;
};

Result<SweepBody> parse_sweep_body(const std::string& text, Asks asks) {
  const Result<json> body = parse_object(text, "the body");
  if (!body) return body.error();
  JsonFields fields(*body, "");
  SweepBody parsed;
  if (asks == Asks::kStart) {
    fields.require("name");
    parsed.name = fields.text("name").value_or("");
  }
  if (body->contains("document") && body->contains("file")) {
    fields.reject("file", ": must not be given with document");
  } else if (!body->contains("document") && asks != Asks::kContinue) {
    fields.require("file");
  }
  if (asks != Asks::kContinue) parsed.file = fields.text("file").value_or("");
  if (const json* document = fields.object("document")) parsed.request.document = *document;
  if (asks != Asks::kCheck) {
    if (const json* border = fields.object("border")) {
      JsonFields wanted(*border, "border");
      wanted.require("axis");
      parsed.request.border = {wanted.text("axis").value_or(""),
                               wanted.text("estimator").value_or("")};
      if (const Status status = wanted.finish(); !status) return status.error();
    }
    const auto most = static_cast<std::int64_t>(SweepService::most_jobs());
    parsed.request.jobs = static_cast<std::size_t>(fields.integer("jobs", 1, most).value_or(0));
  }
  if (const Status status = fields.finish(); !status) return status.error();
  return parsed;
}

/// Puts the document of the file in the request.
Status read_sweep_file(const SweepService& sweeps, SweepBody& body) {
  if (body.file.empty()) return {};
  Result<json> document = experiments::sweep_file_document(sweeps.files_folder(), body.file);
  if (!document) return document.error();
  body.request.document = std::move(*document);
  return {};
}

HttpResponse sweep_refused(SweepRefusal refusal, const Error& error) {
  switch (refusal) {
    case SweepRefusal::kNone:
      break;
    case SweepRefusal::kOff:
      return error_response(403, "forbidden", error.message);
    case SweepRefusal::kMemory:
      return error_response(422, "not_enough_memory", error.message);
    case SweepRefusal::kBusy:
      return error_response(429, "sweep_flying", error.message);
  }
  return error_response(error);
}

HttpResponse entry_response(const SweepService& sweeps, const std::string& name, int status) {
  const Result<json> entry = sweeps.entry(name);
  if (!entry) return error_response(entry.error());
  HttpResponse response = json_response(status, *entry);
  if (status == 201) response.headers.emplace_back("Location", "/api/v1/sweeps/" + name);
  return response;
}

HttpResponse start_sweep(SweepService& sweeps, SweepBody body, Cancel cancel) {
  if (Status status = read_sweep_file(sweeps, body); !status) return error_response(status.error());
  SweepRefusal refusal = SweepRefusal::kNone;
  const Status started = sweeps.start(body.name, body.request, refusal, cancel);
  return started ? entry_response(sweeps, body.name, 201) : sweep_refused(refusal, started.error());
}

HttpResponse continue_sweep(SweepService& sweeps,
                            const std::string& name,
                            const SweepBody& body,
                            Cancel cancel) {
  SweepRefusal refusal = SweepRefusal::kNone;
  const Status started = sweeps.go_on(name, body.request, refusal, cancel);
  return started ? entry_response(sweeps, name, 202) : sweep_refused(refusal, started.error());
}

HttpResponse cost_response(const experiments::SweepCost& cost) {
  json axes = json::array();
  for (const auto& [name, label] : cost.border_axes) {
    axes.push_back({{"name", name}, {"label", label}});
  }
  return json_response(200,
                       {{"valid", true},
                        {"message", ""},
                        {"faults", json::array()},
                        {"cells", cost.cells},
                        {"estimators", cost.estimators.size()},
                        {"estimator_names", cost.estimators},
                        {"border_axes", std::move(axes)},
                        {"flights", cost.flights},
                        {"flight_s", cost.flight_s ? json(*cost.flight_s) : json()}});
}

/// What is at fault is the answer, but for a request that is at fault itself.
HttpResponse check_sweep(const SweepService& sweeps, SweepBody body, Cancel cancel) {
  if (Status status = read_sweep_file(sweeps, body); !status) return error_response(status.error());
  SweepRefusal refusal = SweepRefusal::kNone;
  const auto cost = sweeps.check(body.request.document, refusal, cancel);
  if (cost) return cost_response(*cost);
  if (cost.error().code == ErrorCode::kCancelled) return error_response(cost.error());
  return json_response(200,
                       {{"valid", false},
                        {"message", cost.error().message},
                        {"faults", field_errors_of(cost.error().message)},
                        {"cells", 0},
                        {"estimators", 0},
                        {"estimator_names", json::array()},
                        {"border_axes", json::array()},
                        {"flights", 0},
                        {"flight_s", nullptr}});
}

/// A check of a large sweep takes seconds of a reading thread.
constexpr int kMostChecks = 2;

/// Reads the body, then answers on a reading thread, since every cell of a sweep is checked.
template <typename Answer>
void answer_sweep_request(const SweepRoutes& routes,
                          Asks asks,
                          const RouteCall& call,
                          const Respond& respond,
                          Answer answer) {
  if (auto refused = not_json(call.request)) return respond(std::move(*refused));
  Result<SweepBody> body = parse_sweep_body(call.request.body, asks);
  if (!body) return respond(error_response(body.error()));
  respond_from_reader(routes.readers,
                      "a sweep",
                      call,
                      respond,
                      [answer = std::move(answer), body = std::move(*body)](Cancel cancel) {
                        return Result<HttpResponse>(answer(body, cancel));
                      });
}

json files_json(const SweepService& sweeps) {
  return {
      {"files", experiments::sweep_file_list(sweeps.files_folder())},
      {"published", experiments::published_file_list(sweeps.files_folder())},
      {"jobs", {{"default", SweepService::default_jobs()}, {"most", SweepService::most_jobs()}}}};
}

}  // namespace

void add_sweep_start_routes(RestRouter* router, const SweepRoutes& routes) {
  SweepService* const sweeps = routes.sweeps;
  router->add("GET", "/api/v1/sweep-files", [sweeps](const RouteCall&, const Respond& respond) {
    respond(json_response(200, files_json(*sweeps)));
  });
  router->add(
      "GET", "/api/v1/sweep-files/{name}", [sweeps](const RouteCall& call, const Respond& respond) {
        respond(json_or_error(
            experiments::sweep_file_document(sweeps->files_folder(), call.path.at("name"))));
      });
  router->add("GET",
              "/api/v1/sweeps/{name}/document",
              [sweeps](const RouteCall& call, const Respond& respond) {
                respond(json_or_error(sweeps->document(call.path.at("name"))));
              });
  const auto checks = std::make_shared<std::atomic<int>>(0);
  router->add_long_calculation(
      "/api/v1/sweep-check",
      [routes, sweeps, checks](const RouteCall& call, const Respond& respond) {
        const auto taken = take_slot(checks, kMostChecks);
        if (!taken) {
          return respond(error_response(
              503, "too_many_checks", "other sweeps are being checked: try again soon"));
        }
        answer_sweep_request(routes,
                             Asks::kCheck,
                             call,
                             respond,
                             [sweeps, taken](const SweepBody& body, Cancel cancel) {
                               HttpResponse answer = check_sweep(*sweeps, body, cancel);
                               taken->release();
                               return answer;
                             });
      });
  router->add(
      "POST", "/api/v1/sweeps", [routes, sweeps](const RouteCall& call, const Respond& respond) {
        answer_sweep_request(
            routes, Asks::kStart, call, respond, [sweeps](const SweepBody& body, Cancel cancel) {
              return start_sweep(*sweeps, body, cancel);
            });
      });
  router->add("POST",
              "/api/v1/sweeps/{name}/continue",
              [routes, sweeps](const RouteCall& call, const Respond& respond) {
                answer_sweep_request(
                    routes,
                    Asks::kContinue,
                    call,
                    respond,
                    [sweeps, name = call.path.at("name")](const SweepBody& body, Cancel cancel) {
                      return continue_sweep(*sweeps, name, body, cancel);
                    });
              });
  router->add("DELETE",
              "/api/v1/sweeps/{name}",
              [routes, sweeps](const RouteCall& call, const Respond& respond) {
                respond_from_reader(routes.readers,
                                    "a sweep",
                                    call,
                                    respond,
                                    [sweeps, views = routes.views, name = call.path.at("name")](
                                        Cancel) -> Result<HttpResponse> {
                                      if (const Status gone = sweeps->remove(name); !gone)
                                        return gone.error();
                                      views->drop_deleted();
                                      HttpResponse response;
                                      response.status = 204;
                                      return response;
                                    });
              });
  router->add(
      "POST",
      "/api/v1/sweeps/{name}/cancel",
      [sweeps](const RouteCall& call, const Respond& respond) {
        const std::string& name = call.path.at("name");
        const Status status = sweeps->cancel(name);
        respond(status ? entry_response(*sweeps, name, 202) : error_response(status.error()));
      });
}

}  // namespace overfly::net
