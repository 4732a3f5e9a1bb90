// What a viewer asks for, and the picture that it gets.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/earth/geodesy.hpp"
#include "core/result.hpp"
#include "server/views/track_look.hpp"

namespace overfly::server {

enum class SceneMode { kChase, kOrbit, kTop, kOnboard, kFree };

/// What a scene shows in addition to ground and sky.
struct SceneShow {
  bool ribbons = true;
  bool aircraft = true;
  bool frustum = true;         ///< edges of the main camera's view
  bool footprint = true;       ///< outline of its image on the ground
  bool points = true;          ///< map points of the estimators
  bool image = false;          ///< the main camera's image on the ground
  bool errors = false;         ///< lines from the truth to the estimates at the instant
  bool error_history = false;  ///< likewise along the path
  bool labels = false;         ///< tells where the aircraft are in the picture (Picture::labels)
  bool operator==(const SceneShow&) const = default;
};

/// The viewpoint of the scene. In the modes chase, orbit and top angles give its direction as seen
/// from the target, in the others the line of sight.
struct SceneSettings {
  SceneMode mode = SceneMode::kChase;
  /// Chase: relative to the tail; onboard: relative to the nose; else clockwise from north.
  double azimuth_rad = 0.0;
  /// Above the horizon, onboard above the nose; in [-pi/2, pi/2].
  double elevation_rad = 0.4;
  double distance_m = 120.0;  ///< in [5, 20000]
  bool follow = true;         ///< orbit and top: target = aircraft, else the trajectory's centre
  Eigen::Vector3d eye_world_m = Eigen::Vector3d::Zero();  ///< free: the viewpoint
  SceneShow show;
  int width_px = 960;   ///< in [64, 1920]
  int height_px = 720;  ///< in [64, 1440]
};

/// Tracks of a run in a scene.
struct SceneTracks {
  std::string run_id;
  std::int64_t t_ns = 0;  ///< of the run: the tracks end there
  bool live = false;      ///< use the latest rows if the run is live
  std::string alignment = "init_scale";
  TrackLook look{};
};

/// What an error picture compares.
struct ErrorOf {
  /// The estimator from whose pose the view is drawn; empty: the camera's image itself is compared
  /// with that of an ideal camera.
  std::optional<std::size_t> estimator;
};

/// The pictures of a stream that are sent as video: each but the key pictures needs the one before.
struct VideoChain {
  std::uint64_t viewer = 0;
  std::uint32_t stream = 0;    ///< of the viewer
  std::uint64_t pictures = 0;  ///< of this chain that the client has got
  bool key = false;            ///< the next one must be a key picture
};

/// Time that a preview has for ground that is not in memory: what comes later is drawn from coarser
/// imagery.
constexpr std::int64_t kPreviewTileWaitNs = 10'000'000;

struct PictureRequest {
  std::string run_id;
  enum class Kind { kCamera, kDebug, kScene, kDepth, kError } kind = Kind::kCamera;
  std::size_t estimator = 0;             ///< kDebug
  ErrorOf error;                         ///< kError
  std::string camera;                    ///< not kDebug, kScene: its name; empty = the first one
  std::int64_t t_ns = 0;                 ///< selects the frame at or before it
  bool live = false;                     ///< use the latest picture if the run is live
  SceneSettings scene;                   ///< kScene
  std::string alignment = "init_scale";  ///< kScene, kError: of the estimates
  std::string compared;                  ///< kScene: a second alignment, as dashes; empty = none
  TrackLook look{};                      ///< kScene: of the run's tracks
  std::vector<SceneTracks> others;       ///< kScene: other runs whose tracks are shown
  int quality = 75;                      ///< JPEG, in [1, 100]
  int max_width_px = 1280;               ///< all but scenes are halved until they fit
  /// kCamera, kScene: to be there sooner, a picture that has to be rendered is limited to
  /// kPreviewTileWaitNs, and a camera's one to half its size.
  bool preview = false;
  /// The way to the client is slow: a recorded JPEG is encoded again, not passed on.
  bool sparing = false;
  /// Encodes the picture as video; it becomes a JPEG nevertheless if it is passed on as recorded,
  /// if it is large, or if too many streams are encoded already.
  std::optional<VideoChain> video;
};

enum class PictureCoding { kJpeg, kVp8 };

/// The values at the ends of a picture's colours.
struct ColourScale {
  double low = 0.0;
  double high = 0.0;
  bool logarithmic = false;
  bool operator==(const ColourScale&) const = default;
};

/// Where an aircraft is in a scene's picture.
struct SceneLabel {
  std::string run_id;
  std::string estimator;  ///< empty = the truth
  double x_px = 0.0;
  double y_px = 0.0;
  double distance_m = 0.0;        ///< from the viewpoint
  std::optional<double> error_m;  ///< of an estimate: its distance from the truth
};

struct Picture {
  std::int64_t frame = 0;
  std::int64_t t_ns = 0;
  int width_px = 0;
  int height_px = 0;
  int full_width_px = 0;  ///< of the image before it was reduced
  int full_height_px = 0;
  bool grey = false;
  PictureCoding coding = PictureCoding::kJpeg;
  bool key = true;                   ///< does not need the picture before
  bool preview = false;              ///< of a frame, rendered in half its size
  std::optional<ColourScale> scale;  ///< of depth [m] and error pictures [grey levels]
  std::vector<SceneLabel> labels;    ///< of a scene
  std::shared_ptr<const std::vector<std::uint8_t>> bytes;
};

using PictureDone = std::function<void(Result<Picture>)>;

/// Asks for what one pixel of a camera's frame shows.
struct PixelRequest {
  std::string run_id;
  std::string camera;     ///< empty = the first one
  std::int64_t t_ns = 0;  ///< selects the frame at or before it
  double x_px = 0.0;      ///< of the whole image; pixel centres are at integers
  double y_px = 0.0;
  std::optional<ErrorOf> error;          ///< also the value of this error picture
  std::string alignment = "init_scale";  ///< of the estimate in `error`
};

struct PixelValue {
  std::int64_t frame = 0;
  std::int64_t t_ns = 0;
  std::string camera;
  int width_px = 0;  ///< of the whole image
  int height_px = 0;
  int grey = 0;                                   ///< as given to estimators, of 8 bit
  std::optional<std::array<int, 3>> rgb;          ///< of colour images
  std::optional<int> difference;                  ///< of the error picture that was named
  std::optional<Eigen::Vector3d> ground_world_m;  ///< empty if the pixel sees the sky
  std::optional<Geodetic> ground;
  double depth_m = 0.0;  ///< of the ground along the optical axis
  double range_m = 0.0;  ///< of the ground along the line of sight
};

using PixelDone = std::function<void(Result<PixelValue>)>;

}  // namespace overfly::server
