#include "server/scenario/document/flight/scenario_course.hpp"

#include <string>
#include <utility>

#include "flight/mavlink/vehicle/plan_file.hpp"
#include "server/scenario/document/flight/scenario_airframe.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

constexpr const char* kCoordinated = "coordinated";

flight::CourseParameters course_from(const Json& course) {
  flight::CourseParameters parameters;
  parameters.airspeed_m_s = course.at("airspeed_m_s").get<double>();
  parameters.roll_rate_max_rad_s = rad_from_deg(course.at("roll_rate_max_deg_s").get<double>());
  parameters.height_agl_m = course.at("height_agl_m").get<double>();
  parameters.bank_max_rad = rad_from_deg(course.at("bank_max_deg").get<double>());
  parameters.length_m = course.at("length_m").get<double>();
  parameters.leg_length_m = course.at("leg_length_m").get<double>();
  return parameters;
}

/// What coordinated turns cannot have.
Status check_coordinated(const Json& course) {
  const auto needs_airframe = [](const std::string& field, const Json& value) {
    return Error{ErrorCode::kInvalidArgument,
                 "flight.course." + field + " = " + value.dump() +
                     ": needs an airframe, but flight.course.dynamics = \"coordinated\""};
  };
  if (course.contains("wind")) return needs_airframe("wind", course.at("wind"));
  if (course.at("turbulence") != "none") {
    return needs_airframe("turbulence", course.at("turbulence"));
  }
  if (course.at("terrain_following") != true) {
    return needs_airframe("terrain_following", course.at("terrain_following"));
  }
  if (course.contains("autopilot")) return needs_airframe("autopilot", course.at("autopilot"));
  return {};
}

/// What the autopilot of an airframe cannot have: its limits of RLL2SRV_RMAX and ROLL_LIMIT_DEG.
Status check_limits_of_autopilot(const Json& course) {
  constexpr double kLeastRollRateDegS = 1.0;
  constexpr double kLeastBankDeg = 5.0;
  const auto check = [&](const char* field, double least, const char* unit) -> Status {
    const Json& value = course.at(field);
    if (value.get<double>() >= least) return {};
    return Error{ErrorCode::kInvalidArgument,
                 "flight.course." + std::string(field) + " = " + value.dump() +
                     ": must be at least " + Json(least).dump() + " " + unit + " with an airframe"};
  };
  if (Status rate = check("roll_rate_max_deg_s", kLeastRollRateDegS, "deg/s"); !rate) return rate;
  return check("bank_max_deg", kLeastBankDeg, "deg");
}

Status read_dynamics(Json& course, const FileResolver& files, Scenario& scenario) {
  if (course.at("dynamics") == kCoordinated) return check_coordinated(course);
  Result<AirframeChoice> airframe =
      read_airframe_choice(course, "dynamics", "flight.course", files);
  if (!airframe) return airframe.error();
  if (Status limits = check_limits_of_autopilot(course); !limits) return limits;
  scenario.course_dynamics =
      CourseDynamics{std::move(*airframe), course.at("terrain_following").get<bool>()};
  return {};
}

}  // namespace

Status read_course(Json& course, const FileResolver& files, Scenario& scenario) {
  flight::CourseParameters parameters = course_from(course);
  if (!(parameters.leg_length_m < parameters.length_m)) {
    return Error{
        ErrorCode::kInvalidArgument,
        "flight.course.leg_length_m = " + course.at("leg_length_m").dump() +
            ": must be less than flight.course.length_m = " + course.at("length_m").dump()};
  }
  const Json& start = course.at("start");
  scenario.start_at_runway = !start.is_object();
  if (start.is_object()) {
    parameters.start_east_m = start.at("east_m").get<double>();
    parameters.start_north_m = start.at("north_m").get<double>();
  }
  if (course.contains("heading_deg")) {
    scenario.course_heading_rad = rad_from_deg(course.at("heading_deg").get<double>());
  }
  scenario.flight = parameters;
  return read_dynamics(course, files, scenario);
}

namespace {

/// The plan's text. Errors: kInvalidArgument naming the field.
Result<std::string> read_plan(const Json& plan) {
  const std::string field = "flight.mission.plan";
  std::string text = plan.dump(-1, ' ', false, Json::error_handler_t::replace);
  const auto mission = flight::mavlink::parse_plan(text, field);
  if (mission) return text;
  // The field of the plan as one of the scenario: "flight.mission.plan.mission.items.0.frame = 9".
  std::string message = mission.error().message;
  if (message.starts_with(field + ": ")) message.replace(field.size(), 2, ".");
  return Error{ErrorCode::kInvalidArgument, message};
}

}  // namespace

Result<ScenarioMission> read_mission(Json& mission, const FileResolver& files) {
  ScenarioMission flight;
  Result<AirframeChoice> airframe =
      read_airframe_choice(mission, "airframe", "flight.mission", files);
  if (!airframe) return airframe.error();
  flight.airframe = std::move(*airframe);
  if (mission.contains("plan")) {
    Result<std::string> plan = read_plan(mission.at("plan"));
    if (!plan) return plan.error();
    flight.plan = std::move(*plan);
  } else {
    flight.file = files.resolve(mission.at("file"));
  }
  flight.airspeed_m_s = mission.at("airspeed_m_s").get<double>();
  const Json& home = mission.at("home");
  flight.home_at_runway = home == "runway";
  if (home.is_object()) {
    flight.home_m =
        Eigen::Vector2d(home.at("east_m").get<double>(), home.at("north_m").get<double>());
  }
  return flight;
}

}  // namespace overfly::server
