// The flight of a scenario over its opened world.
#pragma once

#include <atomic>
#include <memory>

#include "core/result.hpp"
#include "core/truth_source.hpp"
#include "server/scenario/scenario.hpp"
#include "terrain/world.hpp"

namespace overfly::engine {

/// A new truth source at t = 0; equal arguments give equal flights.
/// A course starts at the world's runway, or else where it lies centred over the imagery.
/// @param cancel  cancels reading a pose file; may be null
/// Errors: as flight::fly_course and flight::fly_log, prefixed with the scenario's field.
[[nodiscard]] Result<std::unique_ptr<TruthSource>> create_truth(
    const Scenario& scenario,
    const terrain::World& world,
    const std::atomic<bool>* cancel = nullptr);

}  // namespace overfly::engine
