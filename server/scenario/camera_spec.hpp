// One camera of the aircraft, as a scenario describes it.
#pragma once

#include <string>

#include "core/camera_model.hpp"
#include "core/pose.hpp"
#include "renderer/renderer.hpp"
#include "renderer/sensor/mount_vibration.hpp"
#include "renderer/sensor/sensor.hpp"

namespace overfly::engine {

inline constexpr const char* kOnlyCameraName = "camera0";  ///< of a scenario's one `camera`

struct CameraSpec {
  std::string name = kOnlyCameraName;  ///< unique in the scenario; names the files
  CameraModel model;
  /// Where it is mounted; vibration shakes it about this pose.
  Pose T_body_camera{R_body_camera_nadir(), Eigen::Vector3d::Zero()};
  bool rgb = false;              ///< colour images; estimators are given their luma
  renderer::SensorModel sensor;  ///< not enabled: the picture as it is drawn
  renderer::VibrationModel vibration;
  renderer::RenderQuality quality = renderer::RenderQuality::kTrilinear;
  renderer::Atmosphere atmosphere;
};

}  // namespace overfly::engine
