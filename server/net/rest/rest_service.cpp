#include <cmath>
#include <utility>

#include "core/cancel.hpp"
#include "core/motion/pose.hpp"
#include "server/net/http/error_response.hpp"
#include "server/net/rest/openapi.hpp"
#include "server/net/rest/rest_api.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "server/scenario/document/scenario_list.hpp"
#include "server/scenario/document/scenario_schema.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::net {
namespace {

using nlohmann::json;

HttpResponse json_text_response(const std::string& text) {
  HttpResponse response;
  response.content_type = "application/json";
  response.headers.emplace_back("Cache-Control", "no-cache");
  response.body = text;
  return response;
}

json entry_json(const server::ScenarioEntry& entry) {
  return {{"name", entry.name},
          {"title", entry.title},
          {"description", entry.description},
          {"error", entry.error.empty() ? json(nullptr) : json(entry.error)}};
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

}  // namespace

void add_service_routes(RestRouter* router) {
  router->add_quick("/api/v1/health", [](const RouteCall&, const Respond& respond) {
    respond(json_response(200, {{"status", "ok"}, {"version", OVERFLY_VERSION}}));
  });
  router->add("GET", "/api/v1/openapi.json", [](const RouteCall&, const Respond& respond) {
    respond(json_text_response(openapi_text()));
  });
}

void add_scenario_routes(RestRouter* router,
                         server::RunManager* runs,
                         const ReadingRoutes& readers) {
  router->add("GET", "/api/v1/scenarios", [runs](const RouteCall&, const Respond& respond) {
    json list = json::array();
    for (const server::ScenarioEntry& entry : runs->scenarios()) list.push_back(entry_json(entry));
    respond(json_response(200, {{"scenarios", std::move(list)}}));
  });
  router->add(
      "GET", "/api/v1/scenarios/{name}", [runs](const RouteCall& call, const Respond& respond) {
        respond(json_or_error(runs->scenario(call.path.at("name"))));
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
  router->add("GET", "/api/v1/scenario-schema", [](const RouteCall&, const Respond& respond) {
    respond(json_text_response(server::scenario_schema_text()));
  });
}

}  // namespace overfly::net
