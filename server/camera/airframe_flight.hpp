// Flights of a scenario by an airframe and its autopilot.
#pragma once

#include <atomic>
#include <memory>
#include <optional>

#include "core/motion/truth_source.hpp"
#include "core/result.hpp"
#include "flight/autopilot/mission_flight.hpp"
#include "server/scenario/scenario.hpp"
#include "terrain/world.hpp"

namespace overfly::server {

/// Errors: as read_airframe and autopilot::fly_course.
[[nodiscard]] Result<std::unique_ptr<TruthSource>> fly_course_with(
    const flight::CourseParameters& course,
    const CourseDynamics& dynamics,
    std::uint64_t seed,
    const terrain::World& world,
    const std::atomic<bool>* cancel);

/// A mission that begins with a take-off starts with a launch at its home, any other in flight over
/// its home at the height of its first item.
/// Errors: as read_mission_file, read_airframe, plan_mission and autopilot::tuned_for;
/// kInvalidArgument for a home at the runway of a world without one.
[[nodiscard]] Result<autopilot::MissionSetup> mission_setup(const ScenarioMission& mission,
                                                            const terrain::World& world);

/// @param duration_s  ends the flight early; may be empty
/// Errors: as mission_setup and autopilot::fly_mission.
[[nodiscard]] Result<std::unique_ptr<TruthSource>> fly_scenario_mission(
    const ScenarioMission& mission,
    std::uint64_t seed,
    const std::optional<double>& duration_s,
    const terrain::World& world,
    const std::atomic<bool>* cancel);

}  // namespace overfly::server
