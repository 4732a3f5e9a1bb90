// One camera of the aircraft, as the scenario describes it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "core/camera/camera_model.hpp"
#include "core/motion/pose.hpp"
#include "renderer/renderer.hpp"
#include "sensor/mount_vibration.hpp"
#include "sensor/sensor.hpp"

namespace overfly::server {

inline constexpr const char* kOnlyCameraName = "camera0";  ///< name of a scenario's single `camera`

/// What the time stamps of recorded images count from.
enum class ImageClock {
  kFlight,      ///< the start of the flight
  kUtc,         ///< 1970: Unix time
  kLog,         ///< the zero of the clock of the log that is flown
  kFirstImage,  ///< whatever it is: the first image is at the start of the flight
};

/// Recorded images of a real camera.
struct RecordedImages {
  std::filesystem::path source;  ///< a log, a video or a folder
  std::string topic;             ///< or channel, or camera of a data set; empty: see the schema
  std::optional<std::filesystem::path> times;  ///< of the images of a plain folder
  ImageClock clock = ImageClock::kFlight;
  std::int64_t time_offset_ns = 0;          ///< added to the stamps
  std::optional<std::size_t> compare_with;  ///< index of a camera with the same model and mount
};

/// The estimators get intrinsics that are estimated from images of a virtual board.
struct VirtualBoardCalibration {
  DistortionModel model = DistortionModel::kRadtan;  ///< kNone, kRadtan or kEquidistant
  int views = 20;
};

struct CameraSpec {
  std::string name = kOnlyCameraName;  ///< unique in the scenario; used in file names
  CameraModel model;
  /// The mount; vibration moves the camera about this pose.
  Pose T_body_camera{R_body_camera_nadir(), Eigen::Vector3d::Zero()};
  bool rgb = false;            ///< colour images; estimators get their luma
  sensor::SensorModel sensor;  ///< if not enabled, the image stays as rendered
  sensor::VibrationModel vibration;
  renderer::RenderQuality quality = renderer::RenderQuality::kTrilinear;
  renderer::Atmosphere atmosphere;
  std::optional<RecordedImages> images;  ///< take the place of rendered ones
  std::optional<VirtualBoardCalibration> calibrated;
};

}  // namespace overfly::server
