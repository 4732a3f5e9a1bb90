#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "core/cancel.hpp"
#include "core/motion/pose.hpp"
#include "server/net/http/error_response.hpp"
#include "server/net/http/json_text.hpp"
#include "server/net/rest/rest_api.hpp"
#include "server/scenario/document/scenario_schema.hpp"

namespace overfly::net {
namespace {

using nlohmann::json;
using server::RunManager;
using server::SaveRefusal;

json entry_json(const server::ScenarioEntry& entry) {
  return {{"name", entry.name},
          {"title", entry.title},
          {"description", entry.description},
          {"error", entry.error.empty() ? json(nullptr) : json(entry.error)},
          {"flight", entry.flight},
          {"saved", entry.saved}};
}

json place_json(const Geodetic& place) {
  // 1e-7 deg is 11 mm.
  const auto rounded = [](double rad) { return std::round(deg_from_rad(rad) * 1e7) / 1e7; };
  return {{"lat_deg", rounded(place.lat_rad)}, {"lon_deg", rounded(place.lon_rad)}};
}

json extent_json(const server::WorldExtent& extent) {
  json outline = json::array();
  for (const Geodetic& place : extent.outline) outline.push_back(place_json(place));
  return {{"name", extent.name},
          {"attribution", extent.attribution},
          {"centre", place_json(extent.centre)},
          {"outline", std::move(outline)}};
}

HttpResponse save_refused(SaveRefusal refusal, const Error& error) {
  switch (refusal) {
    case SaveRefusal::kNone:
      break;
    case SaveRefusal::kOff:
    case SaveRefusal::kOwned:
      return error_response(403, "forbidden", error.message);
    case SaveRefusal::kFull:
      return error_response(507, "quota_exceeded", error.message);
  }
  return error_response(error);
}

HttpResponse save(RunManager* runs, const RouteCall& call) {
  if (auto refused = not_json(call.request)) return std::move(*refused);
  const std::string replace = call.query_or("replace", "false");
  if (replace != "true" && replace != "false") {
    return error_response(bad_query("replace", replace, "true or false"));
  }
  const Result<json> document = parse_object(call.request.body, "a scenario");
  if (!document) return error_response(document.error());
  SaveRefusal refusal = SaveRefusal::kNone;
  const std::string& name = call.path.at("name");
  const auto saved = runs->library().save(name, *document, replace == "true", refusal);
  if (!saved) return save_refused(refusal, saved.error());
  HttpResponse response = json_response(*saved ? 201 : 200, {{"name", name}});
  response.headers.emplace_back("Location", "/api/v1/scenarios/" + name);
  return response;
}

HttpResponse remove(RunManager* runs, const std::string& name) {
  SaveRefusal refusal = SaveRefusal::kNone;
  const Status removed = runs->library().remove(name, refusal);
  if (!removed) return save_refused(refusal, removed.error());
  HttpResponse gone;
  gone.status = 204;
  return gone;
}

/// Everything that a run of the document would be refused for, but memory and the queue.
HttpResponse check(RunManager* runs, const RouteCall& call) {
  if (auto refused = not_json(call.request)) return std::move(*refused);
  const Result<json> body = parse_object(call.request.body, "the body");
  if (!body) return error_response(body.error());
  JsonFields fields(*body, "");
  fields.require("document");
  const json* const document = fields.object("document");
  if (const Status status = fields.finish(); !status) return error_response(status.error());
  const auto invalid = [](const std::string& message) {
    return json_response(200,
                         {{"valid", false},
                          {"message", message},
                          {"faults", field_errors_of(message)},
                          {"document", nullptr}});
  };
  auto scenario = runs->library().read_to_fly(*document);
  if (!scenario) return invalid(scenario.error().message);
  if (const Status start = runs->check_start(*scenario); !start)
    return invalid(start.error().message);
  return json_response(200,
                       {{"valid", true},
                        {"message", ""},
                        {"faults", json::array()},
                        {"document", std::move(scenario->resolved)}});
}

}  // namespace

void add_scenario_routes(RestRouter* router, RunManager* runs, const ReadingRoutes& readers) {
  router->add("GET", "/api/v1/scenarios", [runs](const RouteCall&, const Respond& respond) {
    json list = json::array();
    for (const server::ScenarioEntry& entry : runs->library().list()) {
      list.push_back(entry_json(entry));
    }
    respond(
        json_response(200, {{"scenarios", std::move(list)}, {"saving", runs->library().saves()}}));
  });
  router->add(
      "GET", "/api/v1/scenarios/{name}", [runs](const RouteCall& call, const Respond& respond) {
        respond(json_or_error(runs->library().document(call.path.at("name"))));
      });
  router->add("PUT",
              "/api/v1/scenarios/{name}",
              [runs](const RouteCall& call, const Respond& respond) { respond(save(runs, call)); },
              {"replace"});
  router->add(
      "DELETE", "/api/v1/scenarios/{name}", [runs](const RouteCall& call, const Respond& respond) {
        respond(remove(runs, call.path.at("name")));
      });
  router->add(
      "GET",
      "/api/v1/scenarios/{name}/world",
      [runs, readers](const RouteCall& call, const Respond& respond) {
        read_and_answer(
            readers,
            "a world",
            call,
            respond,
            [runs, name = call.path.at("name")](const std::atomic<bool>* cancel) -> Result<json> {
              const auto extent =
                  runs->world_extent(name, [cancel] { return is_cancelled(cancel); });
              if (!extent) return extent.error();
              return extent_json(*extent);
            });
      });
  router->add_calculation(
      "/api/v1/scenario-check",
      [runs](const RouteCall& call, const Respond& respond) { respond(check(runs, call)); });
  router->add("GET", "/api/v1/scenario-schema", [](const RouteCall&, const Respond& respond) {
    respond(json_text_response(server::scenario_schema_text()));
  });
}

}  // namespace overfly::net
