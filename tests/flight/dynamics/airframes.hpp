// The airframes of scenarios/airframes/ for tests.
#pragma once

#include <string>

#include "flight/dynamics/airframe_file.hpp"
#include "tests/support/support.hpp"

namespace overfly::dynamics::testing {

inline constexpr const char* kAirframes[] = {"aerosonde", "foam_trainer", "piper_cub_third"};

/// An airspeed at which each flies well [m/s].
inline double cruise_m_s(const std::string& name) { return name == "foam_trainer" ? 10.0 : 25.0; }

inline Airframe airframe(const std::string& name) {
  return read_airframe(overfly::testing::source_file("scenarios/airframes/" + name + ".json"))
      .value();
}

}  // namespace overfly::dynamics::testing
