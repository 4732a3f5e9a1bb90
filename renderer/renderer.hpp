// The renderer's port: views of the world, off-screen. One implementation draws with
// OpenGL over EGL; a no-op one serves tests without a GPU. Both pass one contract test.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/camera.hpp"
#include "core/image.hpp"
#include "core/pose.hpp"
#include "core/result.hpp"
#include "terrain/tile_source.hpp"

namespace overfly::renderer {

enum class PixelFormat { kGrey8, kRgb8 };

/// One image of the aircraft's camera, with all that makes it: the pose in the record is the
/// pose that was drawn.
struct CameraFrame {
  Image image;
  std::int64_t t_ns = 0;
  Pose T_world_camera;
  PinholeCamera camera;
  /// Linear texels of the finest imagery per image pixel, over pixels that see ground with
  /// imagery: below 0.5 the imagery, not the camera, limits the result. 0 when none does.
  double texels_per_pixel_min = 0.0;
  double texels_per_pixel_median = 0.0;
  /// Share of the image that shows ground without imagery, in [0, 1].
  double void_fraction = 0.0;
  /// Depth of the ground along the optical axis [m]; empty when the axis meets the sky.
  std::optional<double> axis_depth_m;
};

/// A trajectory drawn as a strip between the wing tips, tilting with the roll.
struct Ribbon {
  std::array<float, 3> rgb{1.0F, 0.0F, 0.0F};  ///< in [0, 1]
  double wing_span_m = 8.0;
  std::vector<Pose> T_world_body;  ///< in flight order
};

/// A view that is not the aircraft's camera.
struct SceneView {
  int width_px = 960;
  int height_px = 720;
  double fov_y_rad = 0.9;
  Pose T_world_camera;  ///< optical axes, as everywhere
};

/// What a scene view shows besides the ground and the sky.
struct SceneContent {
  struct Aircraft {
    Pose T_world_body;
    std::array<float, 3> rgb{0.9F, 0.1F, 0.1F};
    double wing_span_m = 8.0;
    bool ghost = false;  ///< drawn translucent (an estimate)
  };
  struct Frustum {
    PinholeCamera camera;
    Pose T_world_camera;
    bool footprint = true;  ///< outline of the image on the ground
  };
  std::vector<Aircraft> aircraft;
  std::optional<Frustum> frustum;
  std::vector<Ribbon> ribbons;
  /// Map points of an estimator, world frame [m].
  std::vector<Eigen::Vector3f> points;
};

struct RendererInfo {
  std::string backend;     ///< "egl" or "noop"
  std::string device;      ///< GL_RENDERER
  std::string gl_version;  ///< GL_VERSION
  bool software = true;    ///< true when the CPU draws
};

/// Views of one world. Not thread-safe: create, use and destroy on one thread.
class Renderer {
 public:
  virtual ~Renderer() = default;

  /// Draws the camera's image; every tile it needs is there, at the detail it needs.
  /// Errors: kInvalidArgument for a bad camera or a pose that is not finite or below the ground
  /// by more than 1 m; kIo when a tile cannot be read.
  [[nodiscard]] virtual Result<CameraFrame> render_camera(const PinholeCamera& camera,
                                                          const Pose& T_world_camera,
                                                          std::int64_t t_ns,
                                                          PixelFormat format) = 0;
  /// Depth along the optical axis of the same image [m].
  [[nodiscard]] virtual Result<DepthImage> render_depth(const PinholeCamera& camera,
                                                        const Pose& T_world_camera) = 0;
  /// Draws an RGB view of the scene.
  [[nodiscard]] virtual Result<Image> render_scene(const SceneView& view,
                                                   const SceneContent& content) = 0;
  [[nodiscard]] virtual RendererInfo info() const = 0;
};

struct RendererOptions {
  std::size_t tile_cache_bytes = std::size_t{512} << 20U;  ///< textures kept, > 64 MiB
};

/// Draws with OpenGL on an EGL device or the surfaceless platform, without a display.
/// Errors: kUnsupported with what EGL said and which package is missing.
[[nodiscard]] Result<std::unique_ptr<Renderer>> create_egl_renderer(
    std::shared_ptr<const terrain::TileSource> tiles, const RendererOptions& options = {});

/// Draws nothing: images are a deterministic pattern of their pose. For tests without EGL.
[[nodiscard]] std::unique_ptr<Renderer> create_noop_renderer(
    std::shared_ptr<const terrain::TileSource> tiles);

/// What EGL offers on this machine, without a world (for `overfly doctor`).
[[nodiscard]] Result<RendererInfo> probe_egl();

}  // namespace overfly::renderer
