// What an adapter's two halves agree on: adapter_main.cpp speaks the process protocol (C++17),
// one *_system.cpp calls the upstream library. This header and what it includes stay C++11 and free
// of Eigen and OpenCV: the upstream half must be compiled with the language and machine flags of
// its library, or classes with Eigen members have another layout on the two sides.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "vo_bridges/adapters/parameter_set.hpp"

namespace overfly_adapters {

struct AdapterCamera {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0.0, fy_px = 0.0, cx_px = 0.0, cy_px = 0.0;  ///< (0, 0) = centre of a pixel
  std::string distortion = "none";              ///< "none", "radtan", "equidistant", "fov"
  std::vector<double> distortion_coefficients;  ///< in the model's order
  double rate_hz = 0.0;                         ///< 0 = not known
};

struct AdapterFrame {
  std::int64_t index = 0;
  double t_s = 0.0;
  double exposure_ms = 0.0;              ///< 0 = not known
  const std::uint8_t* pixels = nullptr;  ///< grey, without padding, of the camera's size
  bool debug_wanted = false;
};

enum class AdapterState { kInitialising, kTracking, kLost };

struct RgbImage {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> pixels;  ///< without padding; empty = no image
};

struct AdapterAnswer {
  AdapterState state = AdapterState::kInitialising;
  unsigned map_id = 0;  ///< one more each time the system starts over by itself
  std::array<double, 3> position_vo{{0.0, 0.0, 0.0}};  ///< of T_vo_camera, while tracking
  std::array<double, 4> orientation_xyzw{{0.0, 0.0, 0.0, 1.0}};
  double scene_depth = 0.0;  ///< median, in vo units; 0 = not known
  std::map<std::string, double> counters;
  std::map<std::string, double> timings_ms;
  RgbImage debug_image;
  std::vector<std::array<float, 3>> map_points_vo;
};

/// What the protocol's CALIBRATION and HELLO asked for.
struct Session {
  AdapterCamera camera;
  ParameterValues parameters;  ///< each declared one, resolved
  bool lockstep = true;        ///< every frame is waited for
};

/// One running upstream system. They keep their settings in globals: one in a process.
class UpstreamSystem {
 public:
  virtual ~UpstreamSystem() = default;
  /// Read back from the running system, never echoed from what was wanted. May hold more names than
  /// were declared.
  virtual ParameterValues effective_parameters() = 0;
  virtual AdapterAnswer track(const AdapterFrame& frame) = 0;
  /// Forgets every frame; map_id begins at 0 again.
  virtual void reset() = 0;
};

// Each adapter defines these three.

/// What upstream calls itself, e.g. "ORB-SLAM2".
std::string upstream_name();
/// Its parameters, by upstream's names, and its presets.
const ParameterSet& upstream_parameters();
/// Throws std::runtime_error naming what upstream would not take: it would exit() or go on in
/// silence.
std::unique_ptr<UpstreamSystem> create_upstream_system(const Session& session);

}  // namespace overfly_adapters
