// The sensors of a scenario, in addition to the cameras, over its opened world.
#pragma once

#include <cstdint>
#include <memory>

#include "flight/sensors/sensor_suite.hpp"
#include "server/scenario/scenario.hpp"
#include "terrain/world.hpp"

namespace overfly::server {

/// Null if the scenario has no sensors.
/// @param epoch_utc_ns  date of the flight, for the earth's magnetic field
[[nodiscard]] std::unique_ptr<flight::SensorSuite> create_sensors(const Scenario& scenario,
                                                                  const terrain::World& world,
                                                                  std::int64_t epoch_utc_ns);

}  // namespace overfly::server
