#include "server/scenario/document/scenario_document.hpp"

#include <utility>

#include "server/scenario/document/estimators/scenario_estimators.hpp"
#include "server/scenario/document/flight/scenario_course.hpp"
#include "server/scenario/document/flight/scenario_flight.hpp"
#include "server/scenario/document/flight/scenario_live.hpp"
#include "server/scenario/document/flight/scenario_ros.hpp"
#include "server/scenario/document/flight/scenario_sensors.hpp"
#include "server/scenario/document/scenario_camera.hpp"
#include "server/scenario/document/scenario_faults.hpp"
#include "server/scenario/document/scenario_layers.hpp"
#include "server/scenario/document/scenario_light.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

Status read_flight(Json& document, const FileResolver& files, Scenario& scenario) {
  Json& flight = document.at("flight");
  if (flight.contains("log")) {
    Result<LoggedFlight> log = logged_flight_from(flight.at("log"), files);
    if (!log) return log.error();
    scenario.flight = std::move(*log);
    return {};
  }
  if (flight.contains("run")) {
    scenario.flight = RunFlight{files.resolve(flight.at("run").at("folder"))};
    return {};
  }
  if (flight.contains("mavlink")) {
    Result<flight::live::LiveFlight> live = read_live_flight(flight.at("mavlink"), files);
    if (!live) return live.error();
    scenario.flight = std::move(*live);
    return {};
  }
  if (flight.contains("ros")) {
    Result<flight::ros_live::RosFlight> ros = read_ros_flight(flight.at("ros"));
    if (!ros) return ros.error();
    scenario.flight = std::move(*ros);
    return {};
  }
  if (flight.contains("mission")) {
    Result<ScenarioMission> mission = read_mission(flight.at("mission"), files);
    if (!mission) return mission.error();
    scenario.flight = std::move(*mission);
    return {};
  }
  return read_course(flight.at("course"), files, scenario);
}

/// Logged camera poses are converted to body poses by a nadir mount.
Status check_camera_poses(const Scenario& scenario) {
  const auto* log = std::get_if<LoggedFlight>(&scenario.flight);
  if (log == nullptr || !log->camera_poses) return {};
  const Pose nadir{R_body_camera_nadir(), Eigen::Vector3d::Zero()};
  const Pose& mount = scenario.main_camera().T_body_camera;
  constexpr double kRounding = 1e-9;
  if (mount.translation.norm() < kRounding &&
      rotation_angle_rad(mount.rotation, nadir.rotation) < kRounding) {
    return {};
  }
  return Error{ErrorCode::kInvalidArgument,
               "flight.log.camera_poses = true: the first camera must be mounted nadir, at the "
               "body's origin"};
}

/// Only flights that can be flown from any instant on may start late.
Status check_start(const Scenario& scenario) {
  if (scenario.start_ns == 0) return {};
  const char* what = nullptr;
  if (scenario.is_live()) what = "the flight is live";
  if (scenario.recorded_camera() != nullptr) what = "a camera has recorded images";
  if (what == nullptr) return {};
  return Error{ErrorCode::kInvalidArgument, std::string("start_s: must be 0 because ") + what};
}

/// Faults are scheduled by the frames of a regular rate, which recorded images do not have.
Status check_faults_of_real_images(const Scenario& scenario) {
  if (scenario.faults.empty() || scenario.recorded_camera() == nullptr) return {};
  return Error{ErrorCode::kInvalidArgument,
               "faults: must be empty if a camera has recorded images"};
}

Status read_all(Json& document, const fs::path& base, Scenario& scenario) {
  const FileResolver files(document, base);
  scenario.name = document.at("name").get<std::string>();
  if (!document.contains("title")) document["title"] = scenario.name;
  scenario.title = document.at("title").get<std::string>();
  scenario.description = document.at("description").get<std::string>();
  scenario.seed = document.at("seed").get<std::uint64_t>();
  if (document.contains("epoch_utc_s")) {
    scenario.epoch_utc_ns = document.at("epoch_utc_s").get<std::int64_t>() * kNsPerS;
  }
  scenario.start_ns = ns_from_s(number_or_none(document, "start_s").value_or(0.0));
  scenario.duration_s = number_or_none(document, "duration_s");
  scenario.pacing = document.at("pacing") == "real_time" ? Pacing::kRealTime : Pacing::kLockstep;
  scenario.record_frames = document.at("recording").at("frames").get<bool>();
  scenario.record_debug_hz = document.at("recording").at("debug_hz").get<double>();
  read_world(document, files, scenario);
  if (Status status = read_flight(document, files, scenario); !status) return status;
  if (Status status = read_cameras(document, files, scenario); !status) return status;
  if (Status status = check_camera_poses(scenario); !status) return status;
  if (Status status = check_start(scenario); !status) return status;
  if (Status status = read_sensors(document, scenario); !status) return status;
  if (Status status = read_faults(document, scenario); !status) return status;
  if (Status status = check_faults_of_real_images(scenario); !status) return status;
  read_renderer(document, scenario);
  if (Status status = read_light_and_detail(document, scenario); !status) return status;
  if (Status status = read_estimators(document, base, scenario); !status) return status;
  return find_feedback_estimator(document, scenario);
}

}  // namespace

Result<Scenario> scenario_from(Json document, const fs::path& base) {
  Scenario scenario;
  try {
    if (Status status = read_all(document, base, scenario); !status) return status.error();
  } catch (const Json::exception& error) {
    // The schema accepted a value that this reader does not know: a bug, reported as an error.
    return Error{ErrorCode::kInternal,
                 std::string("scenario schema and reader differ: ") + error.what()};
  }
  scenario.resolved = std::move(document);
  return scenario;
}

}  // namespace overfly::server
