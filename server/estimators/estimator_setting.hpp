#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>

#include "core/motion/pose.hpp"

namespace overfly::server {

/// Environment of an estimator, independent of where its frames come from.
struct EstimatorSetting {
  std::uint64_t seed = 1;  ///< for an estimator whose parameters set no seed
  bool lockstep = true;    ///< each frame waits for its answer
  /// An existing folder reserved for this estimator: working folder of a child process, and
  /// location of its output.log. Empty = this process's working folder, and no log.
  std::filesystem::path output_folder;
  double rate_hz = 0.0;  ///< frame rate of the camera; 0 = not known
  /// When it becomes true, the estimator stops waiting; null = never.
  const std::atomic<bool>* cancel = nullptr;
  bool sensors = false;  ///< its frames have samples of other sensors
  /// Mount of the camera.
  Pose T_body_camera{R_body_camera_nadir(), Eigen::Vector3d::Zero()};
};

}  // namespace overfly::server
