#include "server/app/commands/bench/bench_dynamics.hpp"

#include <string>

#include "flight/dynamics/airframe_file.hpp"
#include "flight/dynamics/flight_speed.hpp"
#include "server/app/install_paths.hpp"

namespace overfly::app {

Result<nlohmann::json> bench_dynamics() {
  constexpr const char* kAirframe = "piper_cub_third";
  constexpr double kAirspeedMPerS = 25.0;
  constexpr double kFlightS = 600.0;
  constexpr double kRateHz = 400.0;
  const auto airframe = dynamics::read_airframe(scenarios_folder() / "airframes" /
                                                (std::string(kAirframe) + ".json"));
  if (!airframe) return airframe.error();
  const Result<double> times =
      dynamics::times_real_time(*airframe, kAirspeedMPerS, kFlightS, kRateHz);
  if (!times) return times.error();
  return nlohmann::json{{"airframe", kAirframe}, {"rate_hz", kRateHz}, {"times_real_time", *times}};
}

}  // namespace overfly::app
