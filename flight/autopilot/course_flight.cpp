#include "flight/autopilot/course_flight.hpp"

#include <cmath>
#include <utility>

#include "core/text/number_text.hpp"
#include "flight/course_plan.hpp"
#include "flight/ground_track.hpp"

namespace overfly::autopilot {
namespace {

flight::GroundTrack track_of(const flight::CourseParameters& course) {
  return {flight::plan_course(course),
          course.airspeed_m_s,
          {course.start_east_m, course.start_north_m, course.heading_rad, 0.0},
          course.length_m / course.airspeed_m_s};
}

Eigen::Vector2d position_of(const flight::GroundSample& at) { return {at.east_m, at.north_m}; }

/// The largest bank of the planned course.
double bank_of(const flight::CourseParameters& course) {
  constexpr double kStepS = 0.05;
  const flight::GroundTrack track = track_of(course);
  double bank_rad = 0.0;
  for (double t_s = 0.0; t_s < track.duration_s(); t_s += kStepS) {
    bank_rad = std::max(bank_rad, std::abs(track.bank_at(t_s).bank_rad));
  }
  return bank_rad;
}

}  // namespace

Mission course_mission(const flight::CourseParameters& course,
                       const CourseAircraft& aircraft,
                       double track_ground_up_m) {
  constexpr double kStepS = 0.01;
  const flight::GroundTrack track = track_of(course);
  const double turn_s = course.leg_length_m / course.airspeed_m_s;
  Mission mission;
  const auto add = [&](const flight::GroundSample& at) {
    MissionItem item;
    item.position_m = position_of(at);
    item.above_ground = aircraft.follow_ground;
    item.height_m = course.height_agl_m + (aircraft.follow_ground ? 0.0 : track_ground_up_m);
    item.number = static_cast<std::uint16_t>(mission.items.size() + 1);
    mission.items.push_back(item);
  };
  add(track.at(turn_s));
  // Half-way through the turn the heading is 90 deg on; each extreme of the swings lies where the
  // heading is that of the way back.
  double wanted_rad = course.heading_rad + 0.5 * kPi;
  double before = track.at(turn_s).heading_rad - wanted_rad;
  for (double t_s = turn_s + kStepS; t_s < track.duration_s(); t_s += kStepS) {
    const flight::GroundSample at = track.at(t_s);
    const double off = at.heading_rad - wanted_rad;
    if (before * off < 0.0) {
      add(at);
      wanted_rad = course.heading_rad + kPi;
    }
    before = at.heading_rad - wanted_rad;
  }
  add(track.at(track.duration_s()));
  return mission;
}

Result<Parameters> course_autopilot(const flight::CourseParameters& course,
                                    const CourseAircraft& aircraft,
                                    const dynamics::Environment& environment,
                                    double up_m) {
  Result<Parameters> tuned = tuned_for(aircraft.airframe, environment, course.airspeed_m_s, up_m);
  if (!tuned) return tuned.error();
  Parameters parameters = std::move(tuned).value();
  parameters.rll2srv_rmax = deg_from_rad(course.roll_rate_max_rad_s);
  parameters.roll_limit_deg = std::max(5.0, deg_from_rad(bank_of(course)));
  // Swings are shorter than the period of ordinary flight.
  parameters.navl1_period = 8.0;
  for (const auto& [name, value] : aircraft.parameters) {
    if (Status status = set_parameter(parameters, name, value); !status) return status.error();
  }
  return parameters;
}

Result<std::unique_ptr<TruthSource>> fly_course(const flight::CourseParameters& course,
                                                const CourseAircraft& aircraft,
                                                const dynamics::Environment& environment,
                                                std::shared_ptr<const HeightQuery> ground,
                                                std::uint64_t seed,
                                                const std::atomic<bool>* cancel) {
  // The coordinated course states what is wrong with its parameters and with the ground.
  if (auto planned = flight::fly_course(course, ground); !planned) return planned.error();
  const double ground_m = ground->ground_up_m(course.start_east_m, course.start_north_m);
  const double start_up_m = ground_m + course.height_agl_m;
  MissionSetup setup;
  setup.airframe = aircraft.airframe;
  setup.environment = environment;
  setup.environment.ground_up_m = ground_m;
  setup.mission = course_mission(course, aircraft, ground_m);
  setup.wind_world_m_s = aircraft.wind_world_m_s;
  setup.turbulence = aircraft.turbulence;
  setup.seed = seed;
  setup.start_world_m = Eigen::Vector3d(course.start_east_m, course.start_north_m, start_up_m);
  setup.heading_rad = course.heading_rad;
  setup.title = "course: " + number_text(course.airspeed_m_s) + " m/s, " +
                number_text(deg_from_rad(course.roll_rate_max_rad_s)) + " deg/s, " +
                number_text(course.height_agl_m) + " m above the ground";
  // The waypoints that make up the course are not the user's.
  setup.report_items = false;
  Result<Parameters> parameters = course_autopilot(course, aircraft, setup.environment, start_up_m);
  if (!parameters) return parameters.error();
  setup.parameters = std::move(parameters).value();
  return fly_mission(setup, std::move(ground), cancel);
}

}  // namespace overfly::autopilot
