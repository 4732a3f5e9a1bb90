// Calibrates a camera from the images in a folder, or from images of a virtual board.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "calibration/calibrator.hpp"
#include "core/result.hpp"
#include "server/calibration/calibration_record.hpp"
#include "server/calibration/virtual_camera.hpp"

namespace overfly::server {

/// Images of a folder beyond this number are an error: the folder is a mistake.
inline constexpr std::size_t kMostCalibrationImages = 20000;

struct CalibrationProgress {
  /// Called after each image; may be empty.
  std::function<void(std::size_t done, std::size_t total, const std::string& what)> show;
  const std::atomic<bool>* cancel = nullptr;  ///< may be null
};

/// Reads the PNG, JPEG, PGM and PPM files of a folder in the order of their names. An image that
/// cannot be read, has another size than the first view, or shows no board is left out, and listed
/// with the reason.
/// Errors: kNotFound; kInvalidArgument for no or too many images, and as Calibrator; kCancelled.
[[nodiscard]] Result<CalibrationRecord> calibrate_images(
    const std::filesystem::path& folder,
    const calibration::CalibratorOptions& options,
    const CalibrationProgress& progress = {});

struct VirtualCalibration {
  VirtualCameraOptions camera;
  std::filesystem::path images;  ///< folder to write the images to, as PNG; empty = none
};

/// Draws a virtual board through the camera, exposes the images with its sensor, and calibrates
/// from them as from a folder. The result contains the truth. Errors: kInvalidArgument as
/// Calibrator, or if the board fits nowhere into the image; kIo; kCancelled.
[[nodiscard]] Result<CalibrationRecord> calibrate_virtual(
    const VirtualCalibration& virtual_camera,
    const calibration::CalibratorOptions& options,
    const CalibrationProgress& progress = {});

}  // namespace overfly::server
