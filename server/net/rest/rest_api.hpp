// The REST resources under /api/v1 (docs/PROTOCOL.md, server/net/rest/openapi.json).
#pragma once

#include "server/net/http/rest_router.hpp"
#include "server/runs/run_manager.hpp"
#include "server/views/view_service.hpp"

namespace overfly::net {

/// health, openapi.json
void add_service_routes(RestRouter* router);
/// scenarios, scenarios/{name}, scenario-schema
void add_scenario_routes(RestRouter* router, server::RunManager* runs);
/// runs, runs/{id}, runs/{id}/cancel
void add_run_routes(RestRouter* router, server::RunManager* runs);
/// runs/{id}/metrics, estimators, manifest, trajectories/{name}
void add_result_routes(RestRouter* router, server::RunManager* runs);
/// runs/{id}/frames/{k}.jpg
void add_frame_routes(RestRouter* router, server::RunManager* runs, server::ViewService* views);

}  // namespace overfly::net
