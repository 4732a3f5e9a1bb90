// Calibrates the virtual cameras of a scenario, as `calibrated` in their description asks for.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>

#include "core/result.hpp"
#include "server/record/calibrated_intrinsics.hpp"
#include "server/scenario/camera_spec.hpp"

namespace overfly::server {

struct CalibrationWatch {
  /// Called with one line before each view; may be empty.
  std::function<void(const std::string&)> notice;
  const std::atomic<bool>* cancel = nullptr;  ///< may be null
};

/// Draws a virtual board through the camera, exposes the images with its sensor, and estimates the
/// camera from them, as `overfly calibrate --scenario` does. A camera with other intrinsics,
/// another sensor or another seed gets another calibration; equal ones get the same to the bit.
/// @pre camera.calibrated
/// Errors: as calibrate_virtual, naming the camera; kInvalidArgument if the estimate is no valid
/// camera; kCancelled.
[[nodiscard]] Result<CalibratedIntrinsics> calibrate_camera(const CameraSpec& camera,
                                                            std::uint64_t seed,
                                                            const CalibrationWatch& watch);

}  // namespace overfly::server
