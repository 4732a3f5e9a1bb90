// Makes the estimators that a scenario asks for.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "core/result.hpp"
#include "core/trajectory.hpp"
#include "server/engine/scenario.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::engine {

/// What the test estimators are given, and no other.
struct ToyTruth {
  Trajectory T_world_camera;   ///< of every frame
  double scene_depth_m = 0.0;  ///< true depth at the first frame; 0 = not known
};

/// @param seed   of an estimator whose parameters name none
/// @param truth  asked only for test estimators
/// Errors: kInvalidArgument naming the estimator, its parameter, value and limit.
[[nodiscard]] Result<std::unique_ptr<VoPort>> create_estimator(
    const EstimatorSpec& spec, std::uint64_t seed, const std::function<Result<ToyTruth>()>& truth);

}  // namespace overfly::engine
