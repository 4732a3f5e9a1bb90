// Interface between an adapter's two halves: adapter_main.cpp implements the process protocol
// (C++17), and one *_system.cpp calls the upstream library. This header and its includes use C++11
// without Eigen and OpenCV. The upstream half must be compiled with the language and machine flags
// of its library, otherwise classes with Eigen members have different layouts in the two halves.
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
  double rate_hz = 0.0;                         ///< 0 = unknown
};

struct AdapterFrame {
  std::int64_t index = 0;
  double t_s = 0.0;
  double exposure_ms = 0.0;              ///< 0 = unknown
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
  unsigned map_id = 0;  ///< +1 each time the system restarts by itself
  std::array<double, 3> position_vo{{0.0, 0.0, 0.0}};  ///< of T_vo_camera; valid while tracking
  std::array<double, 4> orientation_xyzw{{0.0, 0.0, 0.0, 1.0}};
  double scene_depth = 0.0;  ///< median, in vo units; 0 = unknown
  std::map<std::string, double> counters;
  std::map<std::string, double> timings_ms;
  RgbImage debug_image;
  std::vector<std::array<float, 3>> map_points_vo;
};

/// Settings from the protocol's CALIBRATION and HELLO.
struct Session {
  AdapterCamera camera;
  ParameterValues parameters;  ///< all declared parameters, resolved
  bool lockstep = true;        ///< the server waits for every answer
};

/// A running upstream system. Only one per process, because upstream uses global settings.
class UpstreamSystem {
 public:
  virtual ~UpstreamSystem() = default;
  /// Values read back from the running system, never copied from the request. May contain more
  /// names than were declared.
  virtual ParameterValues effective_parameters() = 0;
  virtual AdapterAnswer track(const AdapterFrame& frame) = 0;
};

// Each adapter defines the following three functions.

/// Upstream's name, e.g. "ORB-SLAM2".
std::string upstream_name();
/// Its parameters, by upstream's names, and its presets.
const ParameterSet& upstream_parameters();
/// Throws std::runtime_error naming a setting that upstream does not support: upstream would exit()
/// or continue silently.
std::unique_ptr<UpstreamSystem> create_upstream_system(const Session& session);

}  // namespace overfly_adapters
