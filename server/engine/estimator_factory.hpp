// Makes estimators, native ones and those behind the doors to other processes.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>

#include "core/result.hpp"
#include "core/trajectory.hpp"
#include "server/engine/estimator_spec.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::engine {

/// What the test estimators are given, and no other.
struct ToyTruth {
  Trajectory T_world_camera;   ///< of every frame
  double scene_depth_m = 0.0;  ///< true depth at the first frame; 0 = not known
};

/// Where an estimator is to work, whoever feeds it.
struct EstimatorSetting {
  std::uint64_t seed = 1;  ///< of an estimator whose parameters name none
  bool lockstep = true;    ///< every frame waits for its answer
  /// Exists, and is the estimator's own: a child's working folder, and the place of its
  /// output.log. Empty = ours, and no log.
  std::filesystem::path output_folder;
  double rate_hz = 0.0;  ///< of the camera; 0 = not known
  /// When it turns true the estimator ends its waits; null = never.
  const std::atomic<bool>* cancel = nullptr;
};

/// @param truth  asked only for test estimators; may be empty where there is none to give
/// Errors: kInvalidArgument naming the estimator, its parameter, value and limit; kUnsupported for
/// a door that is not built in; kNotFound, kIo, kInternal for an estimator that does not start.
[[nodiscard]] Result<std::unique_ptr<VoPort>> create_estimator(
    const EstimatorSpec& spec,
    const EstimatorSetting& setting,
    const std::function<Result<ToyTruth>()>& truth = {});

}  // namespace overfly::engine
