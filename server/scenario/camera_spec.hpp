// One camera of the aircraft, as the scenario describes it.
#pragma once

#include <string>

#include "core/camera/camera_model.hpp"
#include "core/motion/pose.hpp"
#include "renderer/renderer.hpp"
#include "sensor/mount_vibration.hpp"
#include "sensor/sensor.hpp"

namespace overfly::server {

inline constexpr const char* kOnlyCameraName = "camera0";  ///< name of a scenario's single `camera`

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
};

}  // namespace overfly::server
