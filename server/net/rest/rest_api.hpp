// The REST resources under /api/v1 (docs/PROTOCOL.md, server/net/rest/openapi.json).
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "server/calibration/session/calibration_desk.hpp"
#include "server/experiments/service/sweep_service.hpp"
#include "server/experiments/studies/study_service.hpp"
#include "server/logs/log_library.hpp"
#include "server/maps/map_service.hpp"
#include "server/net/http/rest_router.hpp"
#include "server/net/rest/progress_board.hpp"
#include "server/net/rest/rest_reading.hpp"
#include "server/runs/run_manager.hpp"
#include "server/trajectories/trajectory_library.hpp"
#include "server/views/view_service.hpp"

namespace overfly::net {

/// health, openapi.json
void add_service_routes(RestRouter* router);
/// scenarios, scenarios/{name}, scenarios/{name}/world, scenario-check, scenario-schema
void add_scenario_routes(RestRouter* router,
                         server::RunManager* runs,
                         const ReadingRoutes& readers);
/// runs, runs/{id}, runs/{id}/cancel, runs/{id}/notes
void add_run_routes(RestRouter* router, server::RunManager* runs, server::ViewService* views);
/// differences
void add_difference_routes(RestRouter* router,
                           server::RunManager* runs,
                           const ReadingRoutes& readers);
/// report
void add_report_routes(RestRouter* router, server::RunManager* runs, const ReadingRoutes& drawers);
/// runs/{id}/metrics, estimators, manifest, scenario, trajectories/{name}
void add_result_routes(RestRouter* router, server::RunManager* runs);
/// runs/{id}/frames/{k}.jpg
void add_frame_routes(RestRouter* router, server::RunManager* runs, server::ViewService* views);
/// runs/{id}/sensors
void add_sensor_routes(RestRouter* router, server::RunManager* runs, const ReadingRoutes& readers);
/// progress/{id}
void add_progress_routes(RestRouter* router, std::shared_ptr<ProgressBoard> progress);
/// What the routes of worlds need.
struct WorldRoutes {
  server::MapService* maps = nullptr;
  ReadingRoutes readers;
  std::shared_ptr<ProgressBoard> progress;
};
/// worlds, worlds/{name}, worlds/{name}/make, worlds/{name}/tiles/{z}/{x}/{y},
/// worlds/{name}/heights
void add_world_routes(RestRouter* router, const WorldRoutes& routes);
/// What the routes of missions need.
struct MissionRoutes {
  server::RunManager* runs = nullptr;
  server::MapService* maps = nullptr;
  ReadingRoutes readers;
};
/// missions/report, scenarios/{name}/plan
void add_mission_routes(RestRouter* router, const MissionRoutes& routes);
/// What the routes of flight logs need.
struct LogRoutes {
  server::LogLibrary* logs = nullptr;
  ReadingRoutes readers;
  std::shared_ptr<ProgressBoard> progress;
};
/// logs, logs/{name}, logs/{name}/series, logs/{name}/residuals
void add_log_routes(RestRouter* router, const LogRoutes& routes);
/// trajectories, trajectories/{name}, trajectories/{name}/series, evaluations
void add_trajectory_routes(RestRouter* router,
                           server::TrajectoryLibrary* library,
                           const ReadingRoutes& readers);

/// What the routes of sweeps need.
struct SweepRoutes {
  server::experiments::SweepService* sweeps = nullptr;
  std::filesystem::path folder;  ///< of the sweeps
  ReadingRoutes readers;
  server::ViewService* views = nullptr;
};
/// sweeps, sweeps/{name}
void add_sweep_routes(RestRouter* router, const SweepRoutes& routes);
/// sweeps/{name}/tables, sweeps/{name}/comparison
void add_sweep_table_routes(RestRouter* router, const SweepRoutes& routes);
/// sweep-files, sweep-files/{name}, sweep-check; starting, continuing and cancelling sweeps
void add_sweep_start_routes(RestRouter* router, const SweepRoutes& routes);
/// What the routes of studies need.
struct StudyRoutes {
  server::experiments::StudyService* studies = nullptr;
  ReadingRoutes readers;
  server::ViewService* views = nullptr;
};
/// studies, studies/{name} and what is in them
void add_study_routes(RestRouter* router, const StudyRoutes& routes);
/// calibration-sources, calibration-sessions and what is in them
void add_calibration_session_routes(RestRouter* router, server::CalibrationDesk* desk);
/// calibrations, calibrations/{name}
void add_calibration_routes(RestRouter* router, server::CalibrationDesk* desk);
/// A camera of a scenario for its calibration. Errors: kNotFound; kInvalidArgument.
[[nodiscard]] Result<server::CameraSpec> scenario_camera(server::RunManager& runs,
                                                         const std::string& scenario,
                                                         const std::string& camera);

}  // namespace overfly::net
