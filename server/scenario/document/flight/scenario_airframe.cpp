#include "server/scenario/document/flight/scenario_airframe.hpp"

#include <algorithm>

#include "flight/dynamics/builtin_airframes.hpp"

namespace overfly::server {
namespace {

std::optional<dynamics::TurbulenceLevel> turbulence_from(const std::string& text) {
  if (text == "light") return dynamics::TurbulenceLevel::kLight;
  if (text == "moderate") return dynamics::TurbulenceLevel::kModerate;
  if (text == "severe") return dynamics::TurbulenceLevel::kSevere;
  return std::nullopt;
}

}  // namespace

Result<AirframeChoice> read_airframe_choice(nlohmann::json& flight,
                                            const std::string& field,
                                            const std::string& path,
                                            const FileResolver& files) {
  AirframeChoice choice;
  const auto name = flight.at(field).get<std::string>();
  const auto known = dynamics::builtin_airframes();
  if (name.ends_with(".json")) {
    choice.file = files.resolve(flight.at(field));
  } else if (std::any_of(known.begin(), known.end(), [&](const auto& airframe) {
               return airframe.name == name;
             })) {
    choice.name = name;
  } else {
    std::string names = field == "dynamics" ? "coordinated, " : "";
    for (const auto& airframe : known) names += std::string(airframe.name) + ", ";
    return Error{ErrorCode::kInvalidArgument,
                 path + "." + field + " = " + flight.at(field).dump() + ": must be one of " +
                     names + "or an airframe file (.json)"};
  }
  if (flight.contains("wind")) {
    choice.wind_from_rad = rad_from_deg(flight.at("wind").at("from_deg").get<double>());
    choice.wind_m_s = flight.at("wind").at("speed_m_s").get<double>();
  }
  choice.turbulence = turbulence_from(flight.at("turbulence").get<std::string>());
  if (flight.contains("autopilot")) {
    choice.autopilot = flight.at("autopilot").get<std::map<std::string, double>>();
  }
  return choice;
}

}  // namespace overfly::server
