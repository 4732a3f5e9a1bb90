// Flights of the airframes by the autopilot, for tests.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>

#include "flight/autopilot/mission_flight.hpp"
#include "tests/flight/dynamics/airframes.hpp"

namespace overfly::autopilot::testing {

inline MissionItem waypoint(double east_m, double north_m, double height_m) {
  MissionItem item;
  item.position_m = {east_m, north_m};
  item.height_m = height_m;
  return item;
}

inline MissionItem item_of(MissionCommand command, const MissionItem& place = {}) {
  MissionItem item = place;
  item.command = command;
  return item;
}

/// An airframe at its cruise, 300 m above flat ground at the origin, heading north.
inline MissionSetup setup_of(const std::string& name) {
  MissionSetup setup;
  setup.airframe = dynamics::testing::airframe(name);
  setup.parameters =
      tuned_for(setup.airframe, setup.environment, dynamics::testing::cruise_m_s(name), 300.0)
          .value();
  setup.start_world_m = Eigen::Vector3d(0.0, 0.0, 300.0);
  setup.seed = 7;
  return setup;
}

/// Flies to the end, or until `look` returns false after a step.
inline MissionFlight fly(
    const MissionSetup& setup,
    const std::function<bool(const MissionFlight&)>& look,
    std::shared_ptr<const HeightQuery> ground = std::make_shared<FlatGround>(0.0)) {
  MissionFlight flight = MissionFlight::create(setup, std::move(ground)).value();
  while (!flight.end()) {
    if (const Status status = flight.step(); !status) {
      ADD_FAILURE() << status.error().message;
      break;
    }
    if (!look(flight)) break;
  }
  return flight;
}

/// A measured figure, as the documents state them.
inline void print_figure(const std::string& what, double value) {
  std::printf("%s: %.3f\n", what.c_str(), value);
}

inline double t_s(const MissionFlight& flight) { return 1e-9 * static_cast<double>(flight.t_ns()); }

}  // namespace overfly::autopilot::testing
