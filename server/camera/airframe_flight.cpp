#include "server/camera/airframe_flight.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "flight/autopilot/course_flight.hpp"
#include "flight/autopilot/mission_items.hpp"
#include "flight/dynamics/airframe_file.hpp"
#include "flight/dynamics/builtin_airframes.hpp"
#include "flight/mavlink/vehicle/plan_file.hpp"

namespace overfly::server {
namespace {

Result<dynamics::Airframe> airframe_of(const AirframeChoice& choice) {
  if (choice.name.empty()) return dynamics::read_airframe(choice.file);
  for (const dynamics::BuiltinAirframe& known : dynamics::builtin_airframes()) {
    if (known.name == choice.name) return dynamics::parse_airframe(known.text, choice.name);
  }
  return Error{ErrorCode::kNotFound, "\"" + choice.name + "\": no such airframe"};
}

/// Wind from the west blows to the east.
Eigen::Vector3d wind_of(const AirframeChoice& choice) {
  return -choice.wind_m_s *
         Eigen::Vector3d(std::sin(choice.wind_from_rad), std::cos(choice.wind_from_rad), 0.0);
}

/// The density of the air follows from the height above the ellipsoid in place of sea level: they
/// differ by up to 100 m, which is 1 % of the density.
dynamics::Environment environment_of(const terrain::World& world) {
  const Geodetic& origin = world.tiles->frame().origin();
  return dynamics::Environment::at(origin, origin.alt_ellipsoid_m);
}

Result<std::optional<Eigen::Vector2d>> home_of(const ScenarioMission& mission,
                                               const terrain::World& world) {
  if (!mission.home_at_runway) return mission.home_m;
  const auto& runway = world.spec.runway;
  if (!runway) {
    return Error{ErrorCode::kInvalidArgument, "home = \"runway\": the world has no runway"};
  }
  const LocalFrame& frame = world.tiles->frame();
  const Eigen::Vector3d threshold =
      frame.world_from_geodetic({runway->lat_rad, runway->lon_rad, frame.origin().alt_ellipsoid_m});
  return std::optional<Eigen::Vector2d>(threshold.head<2>());
}

/// Over home, at the height of the first item that has one.
std::optional<Eigen::Vector3d> start_of(const autopilot::Mission& mission) {
  if (mission.items.front().command == autopilot::MissionCommand::kTakeOff) return std::nullopt;
  Eigen::Vector3d start = mission.home_world_m;
  for (const autopilot::MissionItem& item : mission.items) {
    if (item.command == autopilot::MissionCommand::kSetSpeed) continue;
    start.z() = item.above_ground ? start.z() + item.height_m : item.height_m;
    break;
  }
  return start;
}

}  // namespace

Result<std::unique_ptr<TruthSource>> fly_course_with(const flight::CourseParameters& course,
                                                     const CourseDynamics& dynamics,
                                                     std::uint64_t seed,
                                                     const terrain::World& world,
                                                     const std::atomic<bool>* cancel) {
  Result<dynamics::Airframe> airframe = airframe_of(dynamics.airframe);
  if (!airframe) return airframe.error().in("dynamics");
  autopilot::CourseAircraft aircraft;
  aircraft.airframe = std::move(*airframe);
  aircraft.wind_world_m_s = wind_of(dynamics.airframe);
  aircraft.turbulence = dynamics.airframe.turbulence;
  aircraft.follow_ground = dynamics.terrain_following;
  aircraft.parameters = dynamics.airframe.autopilot;
  return autopilot::fly_course(course, aircraft, environment_of(world), world.tiles, seed, cancel);
}

Result<autopilot::MissionSetup> mission_setup(const ScenarioMission& mission,
                                              const terrain::World& world) {
  Result<dynamics::Airframe> airframe = airframe_of(mission.airframe);
  if (!airframe) return airframe.error().in("airframe");
  const std::string origin = mission.plan.empty() ? mission.file.string() : "plan";
  const auto stored = mission.plan.empty() ? flight::mavlink::read_mission_file(mission.file)
                                           : flight::mavlink::parse_plan(mission.plan, origin);
  if (!stored) return stored.error();
  const auto home_m = home_of(mission, world);
  if (!home_m) return home_m.error();
  Result<autopilot::PlannedMission> planned =
      autopilot::plan_mission(stored->items, world.tiles->frame(), *world.tiles, *home_m);
  if (!planned) return planned.error().in(origin);

  autopilot::MissionSetup setup;
  setup.airframe = std::move(*airframe);
  setup.environment = environment_of(world);
  setup.environment.ground_up_m = planned->mission.home_world_m.z();
  setup.start_world_m = start_of(planned->mission);
  const double up_m = setup.start_world_m.value_or(planned->mission.home_world_m).z();
  Result<autopilot::Parameters> parameters =
      autopilot::tuned_for(setup.airframe, setup.environment, mission.airspeed_m_s, up_m);
  if (!parameters) return parameters.error();
  for (const auto& [name, value] : mission.airframe.autopilot) {
    if (Status status = autopilot::set_parameter(*parameters, name, value); !status) {
      return status.error().in("autopilot");
    }
  }
  setup.parameters = std::move(*parameters);
  setup.mission = std::move(planned->mission);
  setup.heading_rad = planned->heading_rad;
  setup.warnings = stored->warnings;
  setup.warnings.insert(setup.warnings.end(), planned->warnings.begin(), planned->warnings.end());
  setup.wind_world_m_s = wind_of(mission.airframe);
  setup.turbulence = mission.airframe.turbulence;
  setup.title = mission.plan.empty() ? "mission: " + mission.file.filename().string() : "mission";
  return setup;
}

Result<std::unique_ptr<TruthSource>> fly_scenario_mission(const ScenarioMission& mission,
                                                          std::uint64_t seed,
                                                          const std::optional<double>& duration_s,
                                                          const terrain::World& world,
                                                          const std::atomic<bool>* cancel) {
  Result<autopilot::MissionSetup> setup = mission_setup(mission, world);
  if (!setup) return setup.error();
  setup->seed = seed;
  setup->duration_max_s =
      std::min(duration_s.value_or(autopilot::kFlightMaxS), autopilot::kFlightMaxS);
  return autopilot::fly_mission(*setup, world.tiles, cancel);
}

}  // namespace overfly::server
