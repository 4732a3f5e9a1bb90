// The REST resources under /api/v1 (docs/PROTOCOL.md, server/net/rest/openapi.json).
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "server/logs/log_library.hpp"
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
/// What the routes of flight logs need.
struct LogRoutes {
  server::LogLibrary* logs = nullptr;
  /// Runs work on a thread that reads logs. @return false if too much is waiting
  std::function<bool(std::function<void()>, std::shared_ptr<std::atomic<bool>> cancel)> read;
  /// Called with the reason of an internal error.
  std::function<void(const std::string&)> report;
};
/// logs, logs/{name}, logs/{name}/series
void add_log_routes(RestRouter* router, const LogRoutes& routes);

}  // namespace overfly::net
