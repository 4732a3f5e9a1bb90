// What one camera made of one frame.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/image.hpp"
#include "core/truth_source.hpp"
#include "renderer/renderer.hpp"
#include "renderer/sensor/sensor.hpp"

namespace overfly::engine {

struct CameraShot {
  std::size_t camera = 0;           ///< index into Scenario::cameras
  std::string name;                 ///< of the camera
  renderer::CameraRequest request;  ///< as drawn
  /// What the renderer said of it; the images have moved on.
  renderer::CameraFrame drawn;
  Image image;      ///< as the camera gives it, grey or RGB; of deeper sensors the high 8 bits
  Image16 image16;  ///< of sensors deeper than 8 bit; else empty
  renderer::ExposureSetting setting;  ///< exposure 0 = a camera without a sensor model
  double saturated_fraction = 0.0;
  std::int64_t stamp_ns = 0;        ///< what estimators are told; the truth is MadeFrame::t_ns
  std::vector<std::string> faults;  ///< kinds of those that touch the frame
  bool delivered = true;            ///< false: lost on its way to the estimators
};

/// One instant, seen by all cameras.
struct MadeFrame {
  std::int64_t frame = 0;
  std::int64_t t_ns = 0;
  AircraftState state;
  std::vector<CameraShot> shots;  ///< in the order of Scenario::cameras
};

/// The image as estimators are given it: luma (ITU-R BT.601) of a colour image.
[[nodiscard]] Image grey_of(const Image& image);

}  // namespace overfly::engine
