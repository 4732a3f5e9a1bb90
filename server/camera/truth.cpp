#include "server/camera/truth.hpp"

#include <Eigen/Geometry>
#include <utility>

#include "flight/live/fly_live.hpp"
#include "flight/replay/logged_flight.hpp"
#include "flight/ros/ros_truth.hpp"
#include "server/camera/airframe_flight.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/truth_samples.hpp"

namespace overfly::server {
namespace {

/// Centre of the imagery in the world's east-north plane.
Eigen::Vector2d imagery_centre(const Scenario& scenario, const terrain::World& world) {
  const auto* layers = std::get_if<terrain::WorldSpec>(&scenario.world);
  if (layers != nullptr && !layers->origin) return {0.0, 0.0};  // the origin is that centre
  const terrain::TileGrid& grid = world.tiles->grid();
  const double tile_m = grid.tile_m(0);
  const Eigen::Vector3d centre = world.tiles->world_from_map(
      grid.left_x_m + 0.5 * grid.cols * tile_m, grid.top_y_m - 0.5 * grid.rows * tile_m);
  return centre.head<2>();
}

/// Centre of the bounding box of a course that begins at the origin.
Result<Eigen::Vector2d> course_centre(flight::CourseParameters course) {
  course.start_east_m = 0.0;
  course.start_north_m = 0.0;
  auto flown = flight::fly_course(course, std::make_shared<FlatGround>(0.0));
  if (!flown) return flown.error();
  Eigen::AlignedBox2d box;
  const std::int64_t end_ns = (*flown)->duration_ns().value_or(0);
  for (std::int64_t t_ns = 0; t_ns <= end_ns; t_ns += kNsPerS) {
    const auto state = (*flown)->state_at(t_ns);
    if (!state) return state.error();
    if (!*state) break;
    box.extend((*state)->T_world_body.translation.head<2>().eval());
  }
  return Eigen::Vector2d(box.center());
}

Status place_start(const Scenario& scenario,
                   const terrain::World& world,
                   flight::CourseParameters& course) {
  const auto& runway = world.spec.runway;
  if (scenario.course_heading_rad) {
    course.heading_rad = *scenario.course_heading_rad;
  } else if (runway && scenario.start_at_runway) {
    course.heading_rad = runway->heading_rad;
  }
  if (!scenario.start_at_runway) return {};
  if (runway) {
    const double height_m = world.tiles->frame().origin().alt_ellipsoid_m;
    const Eigen::Vector3d threshold =
        world.tiles->frame().world_from_geodetic({runway->lat_rad, runway->lon_rad, height_m});
    course.start_east_m = threshold.x();
    course.start_north_m = threshold.y();
    return {};
  }
  const Result<Eigen::Vector2d> centre = course_centre(course);
  if (!centre) return centre.error();
  const Eigen::Vector2d start = imagery_centre(scenario, world) - *centre;
  course.start_east_m = start.x();
  course.start_north_m = start.y();
  return {};
}

Result<std::unique_ptr<TruthSource>> open_log_flight(const Scenario& scenario,
                                                     const LoggedFlight& log,
                                                     const terrain::World& world,
                                                     const std::atomic<bool>* cancel) {
  if (!flight::is_flight_log(log.file)) {
    if (log.log_fields.empty()) {
      return flight::fly_log(log.file, world.tiles->frame(), log.camera_poses, cancel);
    }
    return Error{ErrorCode::kInvalidArgument,
                 "flight.log." + log.log_fields.front() + ": applies to flight logs, and " +
                     log.file.string() + " is a pose file"};
  }
  if (log.camera_poses) {
    return Error{ErrorCode::kInvalidArgument,
                 "flight.log.camera_poses = true: applies to pose files, and " + log.file.string() +
                     " is a flight log"};
  }
  flight::LogFlightOptions options = log.log;
  if (log.rebase_to_imagery) {
    const Eigen::Vector2d centre = imagery_centre(scenario, world);
    options.rebase->at = flight::PlaceInWorld{centre.x(), centre.y()};
  }
  auto flown = flight::fly_flight_log(
      log.file, options, world.tiles->frame(), *world.tiles, scenario.sources, cancel);
  if (!flown) return flown.error().in("flight.log");
  return flown;
}

}  // namespace

Result<std::unique_ptr<TruthSource>> create_truth(const Scenario& scenario,
                                                  const terrain::World& world,
                                                  const std::atomic<bool>* cancel) {
  if (const auto* log = std::get_if<LoggedFlight>(&scenario.flight)) {
    return open_log_flight(scenario, *log, world, cancel);
  }
  if (const auto* live = std::get_if<flight::live::LiveFlight>(&scenario.flight)) {
    auto flown = flight::live::fly_live(*live, world.tiles->frame(), cancel);
    if (!flown) return flown.error().in("flight.mavlink");
    return flown;
  }
  if (const auto* ros = std::get_if<flight::ros_live::RosFlight>(&scenario.flight)) {
    auto flown = flight::ros_live::fly_ros(*ros, world.tiles->frame(), cancel);
    if (!flown) return flown.error().in("flight.ros");
    return flown;
  }
  if (const auto* mission = std::get_if<MissionFile>(&scenario.flight)) {
    auto flown = fly_mission_file(*mission, scenario.seed, scenario.duration_s, world, cancel);
    if (!flown) return flown.error().in("flight.mission");
    return flown;
  }
  auto course = std::get<flight::CourseParameters>(scenario.flight);
  if (Status status = place_start(scenario, world, course); !status) {
    return status.error().in("flight.course");
  }
  auto truth =
      scenario.course_dynamics
          ? fly_course_with(course, *scenario.course_dynamics, scenario.seed, world, cancel)
          : flight::fly_course(course, world.tiles);
  if (!truth) return truth.error().in("flight.course");
  return truth;
}

Result<std::unique_ptr<TruthSource>> open_flown_truth(const std::filesystem::path& folder,
                                                      const std::string& description,
                                                      const Scenario& scenario,
                                                      const terrain::World& world) {
  auto flown = open_recorded_flight(truth_samples_file(folder), description);
  if (!flown && flown.error().code == ErrorCode::kNotFound && !scenario.is_live()) {
    return create_truth(scenario, world);
  }
  return flown;
}

}  // namespace overfly::server
