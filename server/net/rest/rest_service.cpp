#include "server/net/http/error_response.hpp"
#include "server/net/rest/openapi.hpp"
#include "server/net/rest/rest_api.hpp"

namespace overfly::net {

void add_service_routes(RestRouter* router) {
  router->add_quick("/api/v1/health", [](const RouteCall&, const Respond& respond) {
    respond(json_response(200, {{"status", "ok"}, {"version", OVERFLY_VERSION}}));
  });
  router->add("GET", "/api/v1/openapi.json", [](const RouteCall&, const Respond& respond) {
    respond(json_text_response(openapi_text()));
  });
}

}  // namespace overfly::net
