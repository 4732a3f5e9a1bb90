// The flight of a scenario over its opened world.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>

#include "core/motion/truth_source.hpp"
#include "core/result.hpp"
#include "server/record/run_manifest.hpp"
#include "server/scenario/scenario.hpp"
#include "terrain/world.hpp"

namespace overfly::server {

/// A new truth source at t = 0; equal arguments give equal flights.
/// A course starts at the world's runway, or else where it lies centred over the imagery.
/// @param cancel  cancels reading and smoothing a log, and the first flight of an airframe; may be
/// null
/// @param vehicle_log  where the messages of a live vehicle are recorded; empty: nowhere
/// Errors: as flight::fly_course, autopilot::fly_course, flight::fly_log and
/// flight::fly_flight_log, prefixed with the scenario's field.
[[nodiscard]] Result<std::unique_ptr<TruthSource>> create_truth(
    const Scenario& scenario,
    const terrain::World& world,
    const std::atomic<bool>* cancel = nullptr,
    const std::filesystem::path& vehicle_log = {});

/// The flight of a recorded run, from its samples of the truth. A folder without samples, from an
/// earlier version, gets the flight that its scenario describes.
/// @param folder  of the run
/// @param flight  as in the run's manifest
/// Errors: as open_recorded_flight and create_truth.
[[nodiscard]] Result<std::unique_ptr<TruthSource>> open_flown_truth(
    const std::filesystem::path& folder,
    const RunManifest::Flight& flight,
    const Scenario& scenario,
    const terrain::World& world);

}  // namespace overfly::server
