// A camera's intrinsics in the calibration files of estimators and tools. All of them count pixel
// centres from integers, as Overfly, except DSO.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/camera/camera_model.hpp"
#include "core/result.hpp"

namespace overfly::server {

enum class CameraFormat {
  kOrbSlam2,  ///< the camera's part of ORB-SLAM2's settings (YAML of OpenCV's FileStorage)
  kDso,       ///< camera.txt of DSO and TUM monoVO
  kSvo,       ///< YAML of rpg_vikit's camera loader
  kRos,       ///< camera_info as written by ROS's camera_calibration_parsers (YAML)
  kKalibr,    ///< Kalibr's camchain.yaml with one camera
};

inline constexpr std::array kCameraFormats = {CameraFormat::kOrbSlam2,
                                              CameraFormat::kDso,
                                              CameraFormat::kSvo,
                                              CameraFormat::kRos,
                                              CameraFormat::kKalibr};

/// "orb-slam2", "dso", "svo", "ros", "kalibr".
[[nodiscard]] const char* to_string(CameraFormat format);
[[nodiscard]] std::optional<CameraFormat> camera_format_from(const std::string& text);

/// The text of the file.
/// @param name  of the camera, for ROS
/// Errors: kUnsupported for a lens that the format cannot represent; the message names the lens.
[[nodiscard]] Result<std::string> camera_text(CameraFormat format,
                                              const CameraModel& camera,
                                              const std::string& name);

}  // namespace overfly::server
