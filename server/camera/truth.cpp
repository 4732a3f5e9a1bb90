#include "server/camera/truth.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "flight/live/fly_live.hpp"
#include "flight/replay/flight_events.hpp"
#include "flight/replay/late_start.hpp"
#include "flight/replay/logged_flight.hpp"
#include "flight/ros/ros_truth.hpp"
#include "server/camera/airframe_flight.hpp"
#include "server/record/rows/recorded_events.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/truth_samples.hpp"
#include "server/scenario/document/scenario_list.hpp"
#include "terrain/sea_level.hpp"

namespace overfly::server {
namespace {

/// Centre of the imagery in the world's east-north plane.
Eigen::Vector2d imagery_centre(const Scenario& scenario, const terrain::World& world) {
  const auto* layers = std::get_if<terrain::WorldSpec>(&scenario.world);
  if (layers != nullptr && !layers->origin) return {0.0, 0.0};  // the origin is that centre
  const terrain::TileGrid& grid = world.tiles->grid();
  const Eigen::Vector3d centre = world.tiles->world_from_map(grid.left_x_m + 0.5 * grid.width_m,
                                                             grid.top_y_m - 0.5 * grid.height_m);
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
  if (Status status = check_start_of_log(scenario); !status) return status.error();
  if (log.camera_poses) {
    return Error{ErrorCode::kInvalidArgument,
                 "flight.log.camera_poses = true: applies to pose files, and " + log.file.string() +
                     " is a flight log"};
  }
  flight::LogFlightOptions options = log.log;
  options.sea_level_m = terrain::sea_level_m;
  if (log.rebase_to_imagery) {
    const Eigen::Vector2d centre = imagery_centre(scenario, world);
    options.rebase->at = flight::PlaceInWorld{centre.x(), centre.y()};
  }
  auto flown = flight::fly_flight_log(
      log.file, options, world.tiles->frame(), *world.tiles, scenario.sources, cancel);
  if (!flown) return flown.error().in("flight.log");
  return flown;
}

/// A recorded flight of the length that was flown: the record goes one frame further.
class FlownAgain final : public TruthSource {
 public:
  FlownAgain(std::unique_ptr<TruthSource> record,
             std::int64_t flown_ns,
             std::vector<std::string> warnings)
      : record_(std::move(record)), flown_ns_(flown_ns), warnings_(std::move(warnings)) {}

  [[nodiscard]] std::optional<std::int64_t> duration_ns() const override {
    const std::optional<std::int64_t> recorded_ns = record_->duration_ns();
    return flown_ns_ > 0 && recorded_ns ? std::min(flown_ns_, *recorded_ns) : recorded_ns;
  }
  [[nodiscard]] std::string description() const override { return record_->description(); }
  [[nodiscard]] std::optional<std::int64_t> log_start_ns() const override {
    return record_->log_start_ns();
  }
  [[nodiscard]] std::vector<std::string> warnings() const override {
    std::vector<std::string> warnings = record_->warnings();
    warnings.insert(warnings.end(), warnings_.begin(), warnings_.end());
    return warnings;
  }

 private:
  [[nodiscard]] Result<std::optional<AircraftState>> find_state(
      std::int64_t t_ns, const std::atomic<bool>* cancel) override {
    return record_->state_at(t_ns, cancel);
  }

  std::unique_ptr<TruthSource> record_;
  std::int64_t flown_ns_;  ///< 0: not known
  std::vector<std::string> warnings_;
};

/// The truth that another run recorded counts from the origin of that run's world.
Result<std::unique_ptr<TruthSource>> open_run_flight(const RunFlight& run,
                                                     const terrain::World& world) {
  const Result<ReadManifest> manifest = read_run_manifest(run.folder);
  if (!manifest) return manifest.error();
  if (Status status = manifest->check(ManifestPart::kWorld); !status) return status.error();
  if (!manifest->values.world || !manifest->values.world->origin) {
    return Error{ErrorCode::kConflict, run.folder.string() + ": the run ended before its flight"};
  }
  const Geodetic then = *manifest->values.world->origin;
  const Geodetic& now = world.tiles->frame().origin();
  // The manifest has all digits of the numbers.
  if (then.lat_rad != now.lat_rad || then.lon_rad != now.lon_rad ||
      then.alt_ellipsoid_m != now.alt_ellipsoid_m) {
    const Eigen::Vector3d apart = world.tiles->frame().world_from_geodetic(then);
    constexpr double kSamePlaceM = 1e-6;
    if (apart.norm() > kSamePlaceM) {
      return Error{ErrorCode::kConflict,
                   run.folder.string() + ": the world of that run has its origin " +
                       std::to_string(apart.norm()) + " m away from this one's: must be the same"};
    }
  }
  const RunManifest::Flight flown = manifest->values.flight.value_or(RunManifest::Flight{});
  auto record = open_recorded_flight(truth_samples_file(run.folder),
                                     "run " + folder_name(run.folder) + ": " + flown.description,
                                     flown.log_start_ns);
  if (!record) return record.error();
  // The flight itself does not need its events.
  Result<std::vector<FlightEvent>> events =
      read_recorded_events(run.folder, flight::kMaxOtherEvents);
  std::vector<std::string> warnings;
  if (!events) warnings.push_back("the flight's events are not known: " + events.error().message);
  auto again = std::make_unique<FlownAgain>(
      std::move(*record), manifest->values.duration_ns, std::move(warnings));
  return flight::with_records(
      std::move(again), events ? std::move(*events) : std::vector<FlightEvent>(), nullptr);
}

/// From the beginning of the flight.
Result<std::unique_ptr<TruthSource>> create_whole_truth(const Scenario& scenario,
                                                        const terrain::World& world,
                                                        const std::atomic<bool>* cancel,
                                                        const std::filesystem::path& vehicle_log) {
  if (const auto* log = std::get_if<LoggedFlight>(&scenario.flight)) {
    return open_log_flight(scenario, *log, world, cancel);
  }
  if (const auto* live = std::get_if<flight::live::LiveFlight>(&scenario.flight)) {
    auto flown = flight::live::fly_live(*live, world.tiles->frame(), cancel, {vehicle_log});
    if (!flown) return flown.error().in("flight.mavlink");
    return flown;
  }
  if (const auto* run = std::get_if<RunFlight>(&scenario.flight)) {
    auto flown = open_run_flight(*run, world);
    if (!flown) return flown.error().in("flight.run");
    return flown;
  }
  if (const auto* ros = std::get_if<flight::ros_live::RosFlight>(&scenario.flight)) {
    auto flown = flight::ros_live::fly_ros(*ros, world.tiles->frame(), cancel);
    if (!flown) return flown.error().in("flight.ros");
    return flown;
  }
  if (const auto* mission = std::get_if<ScenarioMission>(&scenario.flight)) {
    std::optional<double> until_s = scenario.duration_s;
    if (until_s) *until_s += s_from_ns(scenario.start_ns);
    auto flown = fly_scenario_mission(*mission, scenario.seed, until_s, world, cancel);
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

}  // namespace

Result<std::unique_ptr<TruthSource>> create_truth(const Scenario& scenario,
                                                  const terrain::World& world,
                                                  const std::atomic<bool>* cancel,
                                                  const std::filesystem::path& vehicle_log) {
  auto flown = create_whole_truth(scenario, world, cancel, vehicle_log);
  if (!flown || scenario.start_ns == 0) return flown;
  return flight::started_late(std::move(*flown), scenario.start_ns);
}

Result<std::unique_ptr<TruthSource>> open_flown_truth(const std::filesystem::path& folder,
                                                      const RunManifest::Flight& flight,
                                                      const Scenario& scenario,
                                                      const terrain::World& world) {
  auto flown =
      open_recorded_flight(truth_samples_file(folder), flight.description, flight.log_start_ns);
  if (!flown && flown.error().code == ErrorCode::kNotFound && !scenario.is_live()) {
    return create_truth(scenario, world);
  }
  return flown;
}

}  // namespace overfly::server
