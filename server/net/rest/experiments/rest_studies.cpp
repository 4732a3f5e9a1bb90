// Studies: why a run failed, where a flight is risky, which flight is the worst.
#include <atomic>
#include <string>
#include <utility>

#include "server/net/http/error_response.hpp"
#include "server/net/rest/experiments/rest_study_request.hpp"
#include "server/net/rest/rest_api.hpp"

namespace overfly::net {
namespace {

namespace experiments = server::experiments;
using experiments::StudyRefusal;
using experiments::StudyService;
using nlohmann::json;
using Cancel = const std::atomic<bool>*;

HttpResponse study_refused(StudyRefusal refusal, const Error& error) {
  switch (refusal) {
    case StudyRefusal::kNone:
      break;
    case StudyRefusal::kOff:
      return error_response(403, "forbidden", error.message);
    case StudyRefusal::kMemory:
      return error_response(422, "not_enough_memory", error.message);
    case StudyRefusal::kFull:
      return error_response(429, "too_many_studies", error.message);
  }
  return error_response(error);
}

HttpResponse study_response(const StudyService& studies, const std::string& name, int status) {
  const Result<json> entry = studies.entry(name);
  if (!entry) return error_response(entry.error());
  HttpResponse response = json_response(status, *entry);
  if (status == 201) response.headers.emplace_back("Location", "/api/v1/studies/" + name);
  return response;
}

HttpResponse start_study(StudyService& studies,
                         const experiments::StudyRequest& request,
                         Cancel cancel) {
  StudyRefusal refusal = StudyRefusal::kNone;
  const Result<std::string> name = studies.start(request, refusal, cancel);
  return name ? study_response(studies, *name, 201) : study_refused(refusal, name.error());
}

/// A handler that works with the study of the path on a reading thread.
/// @param work  (StudyService&, name) -> Result<HttpResponse>
template <typename Work>
auto on_study(const StudyRoutes& routes, Work work) {
  return [routes, work](const RouteCall& call, const Respond& respond) {
    respond_from_reader(routes.readers,
                        "a study",
                        call,
                        respond,
                        [studies = routes.studies, name = call.path.at("name"), work](Cancel) {
                          return Result<HttpResponse>(work(*studies, name));
                        });
  };
}

HttpResponse continue_study(StudyService& studies, const std::string& name) {
  StudyRefusal refusal = StudyRefusal::kNone;
  const Status status = studies.go_on(name, refusal);
  return status ? study_response(studies, name, 202) : study_refused(refusal, status.error());
}

HttpResponse delete_study(StudyService& studies,
                          server::ViewService& views,
                          const std::string& name) {
  if (const Status status = studies.remove(name); !status) return error_response(status.error());
  views.drop_deleted();
  HttpResponse gone;
  gone.status = 204;
  return gone;
}

Result<HttpResponse> study_with_result(StudyService& studies, const std::string& name) {
  Result<json> entry = studies.entry(name);
  if (!entry) return entry.error();
  Result<json> result = studies.result(name);
  if (!result) return result.error();
  return json_response(200, {{"study", std::move(*entry)}, {"result", std::move(*result)}});
}

Result<HttpResponse> study_page(StudyService& studies, const std::string& name) {
  const Result<std::string> page = studies.page(name);
  if (!page) return page.error();
  return page_response(*page);
}

Result<HttpResponse> study_worst(StudyService& studies, const std::string& name) {
  const Result<json> worst = studies.worst(name);
  if (!worst) return worst.error();
  return json_response(200, *worst);
}

}  // namespace

void add_study_routes(RestRouter* router, const StudyRoutes& routes) {
  StudyService* const studies = routes.studies;
  router->add(
      "GET", "/api/v1/studies", [routes, studies](const RouteCall& call, const Respond& respond) {
        read_and_answer(routes.readers, "studies", call, respond, [studies](Cancel) {
          json list = studies->list();
          list["limits"] = study_limits_json();
          return Result<json>(std::move(list));
        });
      });
  router->add(
      "POST", "/api/v1/studies", [routes, studies](const RouteCall& call, const Respond& respond) {
        if (auto refused = not_json(call.request)) return respond(std::move(*refused));
        Result<experiments::StudyRequest> request = parse_study_request(call.request.body);
        if (!request) return respond(error_response(request.error()));
        respond_from_reader(routes.readers,
                            "a study",
                            call,
                            respond,
                            [studies, request = std::move(*request)](Cancel cancel) {
                              return Result<HttpResponse>(start_study(*studies, request, cancel));
                            });
      });
  router->add("GET", "/api/v1/studies/{name}", on_study(routes, study_with_result));
  router->add("GET", "/api/v1/studies/{name}/page", on_study(routes, study_page));
  router->add("GET", "/api/v1/studies/{name}/worst", on_study(routes, study_worst));
  router->add("POST", "/api/v1/studies/{name}/continue", on_study(routes, continue_study));
  router->add(
      "DELETE",
      "/api/v1/studies/{name}",
      on_study(routes, [views = routes.views](StudyService& service, const std::string& name) {
        return delete_study(service, *views, name);
      }));
  router->add(
      "POST",
      "/api/v1/studies/{name}/cancel",
      [studies](const RouteCall& call, const Respond& respond) {
        const std::string& name = call.path.at("name");
        const Status status = studies->cancel(name);
        respond(status ? study_response(*studies, name, 202) : error_response(status.error()));
      });
}

}  // namespace overfly::net
