// What a viewer asks for, and the picture that it gets.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace overfly::server {

enum class SceneMode { kChase, kOrbit, kTop };

/// The viewpoint of the scene. Angles give its direction as seen from the target.
struct SceneSettings {
  SceneMode mode = SceneMode::kChase;
  double azimuth_rad = 0.0;    ///< chase: relative to the tail; orbit: clockwise from north
  double elevation_rad = 0.4;  ///< above the horizon, in [-0.2, pi/2]
  double distance_m = 120.0;   ///< in [5, 20000]
  bool follow = true;          ///< orbit and top: target = aircraft, else the trajectory's centre
  int width_px = 960;          ///< in [64, 1920]
  int height_px = 720;         ///< in [64, 1440]
};

/// Tracks of a run in a scene.
struct SceneTracks {
  std::string run_id;
  std::int64_t t_ns = 0;  ///< of the run: the tracks end there
  bool live = false;      ///< use the latest rows if the run is live
  std::string alignment = "init_scale";
  std::size_t first_colour = 0;  ///< index of the first estimator's colour
};

struct PictureRequest {
  std::string run_id;
  enum class Kind { kCamera, kDebug, kScene } kind = Kind::kCamera;
  std::size_t estimator = 0;             ///< kDebug
  std::string camera;                    ///< kCamera: its name; empty = the first one
  std::int64_t t_ns = 0;                 ///< selects the frame at or before it
  bool live = false;                     ///< use the latest picture if the run is live
  SceneSettings scene;                   ///< kScene
  std::string alignment = "init_scale";  ///< kScene: of the estimates
  std::size_t first_colour = 0;          ///< kScene: index of the first estimator's colour
  std::vector<SceneTracks> others;       ///< kScene: other runs whose tracks are shown
  int quality = 75;                      ///< JPEG, in [1, 100]
  int max_width_px = 1280;               ///< camera and debug images are halved until they fit
};

struct Picture {
  std::int64_t frame = 0;
  std::int64_t t_ns = 0;
  int width_px = 0;
  int height_px = 0;
  bool grey = false;
  std::shared_ptr<const std::vector<std::uint8_t>> jpeg;
};

using PictureDone = std::function<void(Result<Picture>)>;

}  // namespace overfly::server
