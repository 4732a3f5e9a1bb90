// overfly vehicle: a simulated aircraft that ground stations and scenarios connect to by MAVLink.
#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>
#include <memory>
#include <string>

#include "flight/dynamics/airframe_file.hpp"
#include "flight/dynamics/builtin_airframes.hpp"
#include "flight/vehicle/serve_vehicle.hpp"
#include "server/app/commands/commands.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/place_argument.hpp"
#include "server/app/stop_signal.hpp"

namespace overfly::app {
namespace {

struct VehicleArguments {
  std::string link = "tcp-listen:127.0.0.1:5760";
  std::string airframe = "piper_cub_third";
  double airspeed_m_s = 25.0;
  /// The runway of the built-in world with seed 1.
  std::string home = "39.355375,-86.030728,227.7";
  double heading_deg = 174.0;
  double speed_up = 1.0;
  double wind_m_s = 0.0;
  double wind_from_deg = 270.0;
  std::string turbulence = "none";
  std::uint64_t seed = 1;
  unsigned system = 1;
};

Result<dynamics::Airframe> airframe_from(const std::string& name) {
  for (const dynamics::BuiltinAirframe& known : dynamics::builtin_airframes()) {
    if (known.name == name) return dynamics::parse_airframe(known.text, name);
  }
  if (name.ends_with(".json")) return dynamics::read_airframe(name);
  std::string names;
  for (const auto& known : dynamics::builtin_airframes()) names += std::string(known.name) + ", ";
  return Error{ErrorCode::kInvalidArgument,
               "--airframe " + name + ": must be one of " + names + "or an airframe file (.json)"};
}

Status check_numbers(const VehicleArguments& arguments) {
  const auto check = [](const char* option, double value, double low, double high) -> Status {
    if (value >= low && value <= high) return {};
    return Error{ErrorCode::kInvalidArgument,
                 std::string(option) + " " + std::to_string(value) + ": must be in [" +
                     std::to_string(low) + ", " + std::to_string(high) + "]"};
  };
  if (Status s = check("--airspeed-m-s", arguments.airspeed_m_s, 5.0, 80.0); !s) return s;
  if (Status s = check("--heading-deg", arguments.heading_deg, -360.0, 360.0); !s) return s;
  if (Status s = check("--speed-up", arguments.speed_up, 0.01, 100.0); !s) return s;
  if (Status s = check("--wind-m-s", arguments.wind_m_s, 0.0, 0.9 * arguments.airspeed_m_s); !s) {
    return s;
  }
  if (Status s = check("--wind-from-deg", arguments.wind_from_deg, -360.0, 360.0); !s) return s;
  return check("--system", arguments.system, 1, 254);
}

Result<std::optional<dynamics::TurbulenceLevel>> turbulence_from(const std::string& text) {
  using Level = std::optional<dynamics::TurbulenceLevel>;
  if (text == "none") return Level();
  if (text == "light") return Level(dynamics::TurbulenceLevel::kLight);
  if (text == "moderate") return Level(dynamics::TurbulenceLevel::kModerate);
  if (text == "severe") return Level(dynamics::TurbulenceLevel::kSevere);
  return Error{ErrorCode::kInvalidArgument,
               "--turbulence " + text + ": must be none, light, moderate or severe"};
}

int fly_vehicle(const VehicleArguments& arguments) {
  if (Status status = check_numbers(arguments); !status) return report(status.error());
  const auto link = flight::mavlink::parse_link_address(arguments.link, "--link");
  if (!link) return report(link.error());
  vehicle::VehicleSetup setup;
  Result<dynamics::Airframe> airframe = airframe_from(arguments.airframe);
  if (!airframe) return report(airframe.error());
  setup.airframe = std::move(*airframe);
  const Result<Geodetic> home = place_from("--home", arguments.home);
  if (!home) return report(home.error());
  setup.home = *home;
  const auto turbulence = turbulence_from(arguments.turbulence);
  if (!turbulence) return report(turbulence.error());
  setup.turbulence = *turbulence;
  setup.airspeed_m_s = arguments.airspeed_m_s;
  setup.heading_rad = rad_from_deg(arguments.heading_deg);
  const double from_rad = rad_from_deg(arguments.wind_from_deg);
  setup.wind_world_m_s =
      -arguments.wind_m_s * Eigen::Vector3d(std::sin(from_rad), std::cos(from_rad), 0.0);
  setup.seed = arguments.seed;
  setup.system = static_cast<std::uint8_t>(arguments.system);
  auto aircraft = vehicle::SimulatedVehicle::create(setup);
  if (!aircraft) return report(aircraft.error());
  const std::atomic<bool>& stop = catch_stop_signals();
  const Status flown =
      vehicle::serve_vehicle(**aircraft, *link, arguments.speed_up, stop, [&](const auto& opened) {
        std::cout << "vehicle " << arguments.system << ".1 (" << setup.airframe.name << ") on "
                  << opened.text() << std::endl;
      });
  if (const std::uint64_t estimates = (*aircraft)->received_estimates(); estimates > 0) {
    std::cout << "received " << estimates << " estimates of its position" << std::endl;
  }
  return flown ? kExitOk : report(flown.error());
}

}  // namespace

void add_vehicle_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<VehicleArguments>();
  CLI::App* const command = app.add_subcommand(
      "vehicle", "A simulated aircraft with autopilot that ground stations connect to by MAVLink");
  command->add_option("--link", arguments->link, "udp:HOST:PORT, tcp-listen:HOST:PORT, ...")
      ->capture_default_str();
  command->add_option("--airframe", arguments->airframe, "Built-in airframe or airframe file")
      ->capture_default_str();
  command->add_option("--airspeed-m-s", arguments->airspeed_m_s, "Cruise")->capture_default_str();
  command->add_option("--home", arguments->home, "LAT,LON,HEIGHT: degrees, metres above sea level")
      ->capture_default_str();
  command->add_option("--heading-deg", arguments->heading_deg, "Of the runway")
      ->capture_default_str();
  command->add_option("--speed-up", arguments->speed_up, "Times the wall clock")
      ->capture_default_str();
  command->add_option("--wind-m-s", arguments->wind_m_s, "Steady wind")->capture_default_str();
  command->add_option("--wind-from-deg", arguments->wind_from_deg, "Clockwise from north")
      ->capture_default_str();
  command->add_option("--turbulence", arguments->turbulence, "none, light, moderate, severe")
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "Of the turbulence")->capture_default_str();
  command->add_option("--system", arguments->system, "MAVLink system number")
      ->capture_default_str();
  command->callback([arguments, &exit_code] { exit_code = fly_vehicle(*arguments); });
}

}  // namespace overfly::app
