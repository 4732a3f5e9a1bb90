// Flights of a scenario by an airframe and its autopilot.
#pragma once

#include <atomic>
#include <memory>
#include <optional>

#include "core/motion/truth_source.hpp"
#include "core/result.hpp"
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
/// @param duration_s  ends the flight early; may be empty
/// Errors: as read_mission_file, read_airframe, plan_mission and fly_mission; kInvalidArgument for
/// a home at the runway of a world without one.
[[nodiscard]] Result<std::unique_ptr<TruthSource>> fly_mission_file(
    const MissionFile& mission,
    std::uint64_t seed,
    const std::optional<double>& duration_s,
    const terrain::World& world,
    const std::atomic<bool>* cancel);

}  // namespace overfly::server
