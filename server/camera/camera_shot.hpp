// One camera's result for one frame.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/camera/image.hpp"
#include "core/motion/truth_source.hpp"
#include "core/result.hpp"
#include "core/sensors/sensor_samples.hpp"
#include "renderer/renderer.hpp"
#include "sensor/sensor.hpp"
#include "server/record/rows/rows.hpp"

namespace overfly::server {

/// In CameraShot::faults: the recorded image of the frame is missing or cannot be decoded.
inline constexpr const char* kUnreadableImage = "unreadable_image";

struct CameraShot {
  std::size_t camera = 0;           ///< index into Scenario::cameras
  std::string name;                 ///< the camera's name
  renderer::CameraRequest request;  ///< as drawn
  /// The renderer's metadata; its images have been moved out.
  renderer::CameraFrame drawn;
  Image image;      ///< as the camera delivers it, grey or RGB; the high 8 bits of deeper sensors
  Image16 image16;  ///< from sensors deeper than 8 bit; else empty
  sensor::ExposureSetting setting;  ///< exposure 0 = a camera without a sensor model
  double saturated_fraction = 0.0;  ///< of the pixels
  std::int64_t stamp_ns = 0;        ///< as given to estimators; the true time is MadeFrame::t_ns
  std::vector<std::string> faults;  ///< kinds of the faults that affect the frame
  bool delivered = true;            ///< false: lost before it reached the estimators
  std::int64_t source_image = -1;   ///< of a recorded image: its number in the source
  std::string problem;              ///< why a recorded image is lost
};

/// One instant, as seen by all cameras and measured by the other sensors.
struct MadeFrame {
  std::int64_t frame = 0;
  std::int64_t t_ns = 0;
  AircraftState state;
  std::vector<CameraShot> shots;  ///< in the order of Scenario::cameras
  /// Of the other sensors: what has become available since the previous made frame.
  SensorSamples sensors;
};

/// Checks time and camera pose of a frame that is rendered again against the run's record.
/// Errors: kConflict if they differ by more than the rounding of another C library.
[[nodiscard]] Status check_recorded_pose(const FrameRow& recorded,
                                         std::int64_t t_ns,
                                         const Pose& T_world_camera);

/// The image as given to estimators: luma (ITU-R BT.601) of a colour image.
[[nodiscard]] Image grey_of(const Image& image);

}  // namespace overfly::server
