// The camera in a calibration file (docs/CALIBRATION.md).
#pragma once

#include <filesystem>

#include "core/camera/camera_model.hpp"
#include "core/result.hpp"

namespace overfly::server {

inline constexpr const char* kCalibrationFormat = "overfly-calibration";
inline constexpr int kCalibrationFormatVersion = 1;

/// Errors: as read_json; kUnreadable naming file and field.
[[nodiscard]] Result<CameraModel> read_calibrated_camera(const std::filesystem::path& file);

}  // namespace overfly::server
