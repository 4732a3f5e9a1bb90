// Airframe files. An airframe that is accepted is trimmed and flown for a moment: its motion must
// stay finite, or end with an error.
#include <cstdlib>

#include "flight/dynamics/aircraft.hpp"
#include "flight/dynamics/airframe_file.hpp"
#include "flight/dynamics/trim.hpp"
#include "tests/fuzz/input_folder.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace overfly;
  const auto airframe = dynamics::parse_airframe(fuzz::text_of(data, size), "airframe.json");
  if (!airframe) return 0;
  dynamics::AircraftSetup setup;
  setup.airframe = *airframe;
  dynamics::TrimRequest request;
  request.airspeed_m_s = 25.0;
  (void)dynamics::trim(setup.airframe, setup.environment, request);
  dynamics::BodyState start;
  start.v_body_m_s = {20.0, 3.0, -4.0};
  start.omega_body_rad_s = {5.0, -3.0, 2.0};
  auto aircraft = dynamics::Aircraft::create(setup, start, {0.0, 0.0, 0.0, 1.0}).value();
  for (int i = 0; i < 100; ++i) {
    if (!aircraft.step({0.3, -0.3, 0.3, 1.0}, 0.01)) break;  // refused, with the state as it was
  }
  if (!aircraft.state().v_body_m_s.allFinite()) std::abort();
  if (!aircraft.state().omega_body_rad_s.allFinite()) std::abort();
  return 0;
}
