#include "server/scenario/document/scenario_course.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "flight/dynamics/builtin_airframes.hpp"

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

std::optional<dynamics::TurbulenceLevel> turbulence_from(const std::string& text) {
  if (text == "light") return dynamics::TurbulenceLevel::kLight;
  if (text == "moderate") return dynamics::TurbulenceLevel::kModerate;
  if (text == "severe") return dynamics::TurbulenceLevel::kSevere;
  return std::nullopt;
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

/// A name that ends with .json is a file; any other must be a built-in airframe.
Status read_dynamics(Json& course, const FileResolver& files, Scenario& scenario) {
  const auto name = course.at("dynamics").get<std::string>();
  if (name == kCoordinated) return check_coordinated(course);
  CourseDynamics dynamics;
  const auto known = dynamics::builtin_airframes();
  if (name.ends_with(".json")) {
    dynamics.airframe_file = files.resolve(course.at("dynamics"));
  } else if (std::any_of(known.begin(), known.end(), [&](const auto& airframe) {
               return airframe.name == name;
             })) {
    dynamics.airframe = name;
  } else {
    std::string names = kCoordinated;
    for (const auto& airframe : known) names += ", " + std::string(airframe.name);
    return Error{ErrorCode::kInvalidArgument,
                 "flight.course.dynamics = " + course.at("dynamics").dump() + ": must be one of " +
                     names + ", or an airframe file (.json)"};
  }
  if (course.contains("wind")) {
    dynamics.wind_from_rad = rad_from_deg(course.at("wind").at("from_deg").get<double>());
    dynamics.wind_m_s = course.at("wind").at("speed_m_s").get<double>();
  }
  dynamics.turbulence = turbulence_from(course.at("turbulence").get<std::string>());
  dynamics.terrain_following = course.at("terrain_following").get<bool>();
  if (course.contains("autopilot")) {
    dynamics.autopilot = course.at("autopilot").get<std::map<std::string, double>>();
  }
  scenario.course_dynamics = std::move(dynamics);
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

}  // namespace overfly::server
