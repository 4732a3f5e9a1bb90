// Pictures for viewers: the camera, debug and scene views of a run at any instant, drawn on one
// thread of its own, which beside a flight in real time gets only what that leaves of the machine.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/engine/run_manager.hpp"

namespace overfly::engine {

enum class SceneMode { kChase, kOrbit, kTop };

/// How a viewer looks at the scene. Angles are the viewpoint's as seen from the target.
struct SceneSettings {
  SceneMode mode = SceneMode::kChase;
  double azimuth_rad = 0.0;    ///< chase: relative to the tail; orbit: clockwise from north
  double elevation_rad = 0.4;  ///< above the horizon, in [-0.2, pi/2]
  double distance_m = 120.0;   ///< in [5, 20000]
  bool follow = true;          ///< orbit and top: target = aircraft, else the trajectory's centre
  int width_px = 960;          ///< in [64, 1920]
  int height_px = 720;         ///< in [64, 1440]
  std::string alignment = "init_scale";  ///< of the estimates shown
};

struct PictureRequest {
  std::string run_id;
  enum class Kind { kCamera, kDebug, kScene } kind = Kind::kCamera;
  std::size_t estimator = 0;  ///< kDebug
  std::string camera;         ///< kCamera: its name; empty = the first one
  std::int64_t t_ns = 0;      ///< the frame at or before it
  bool live = false;          ///< the newest picture of a running run, if it has one
  SceneSettings scene;        ///< kScene
  int quality = 75;           ///< JPEG, in [1, 100]
  int max_width_px = 1280;    ///< camera and debug images are halved until they fit
};

struct Picture {
  std::int64_t frame = 0;
  std::int64_t t_ns = 0;
  int width_px = 0;
  int height_px = 0;
  bool grey = false;
  std::shared_ptr<const std::vector<std::uint8_t>> jpeg;
};

/// Thread-safe. Keeps one renderer per world in use, the least recently used leaves.
class ViewService {
 public:
  using Done = std::function<void(Result<Picture>)>;

  explicit ViewService(RunManager& runs);
  /// Waits for the picture that is being drawn; a world that is being opened for one is given up.
  ~ViewService();

  /// Queues a picture for a client's stream; a request not yet begun of the same (client, stream)
  /// is replaced and its `done` gets kCancelled: a slow machine shows newer pictures, not more.
  /// `done` is called on the service's thread.
  void request(std::uint64_t client, int stream, const PictureRequest& request, Done done);
  /// Drops what a client still waits for, without calling its `done`s.
  void forget(std::uint64_t client);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace overfly::engine
