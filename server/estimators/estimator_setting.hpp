#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>

#include "core/trajectory.hpp"

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

}  // namespace overfly::engine
