// The renderer's port: off-screen views of the world. One implementation draws with OpenGL over
// EGL, one casts rays on the CPU (camera only), and a no-op one serves tests without either. All
// pass one contract test.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/camera/camera.hpp"
#include "core/camera/camera_model.hpp"
#include "core/camera/camera_motion.hpp"
#include "core/camera/image.hpp"
#include "core/motion/pose.hpp"
#include "core/result.hpp"
#include "terrain/tile_source.hpp"

namespace overfly::renderer {

enum class PixelFormat {
  kGrey8,
  kRgb8,
  /// Linear radiance: the imagery's sRGB transfer function (IEC 61966-2-1) is decoded before texels
  /// are filtered; the input of a sensor model.
  kGreyLinear,
  kRgbLinear,
};

[[nodiscard]] constexpr bool is_linear(PixelFormat format) {
  return format == PixelFormat::kGreyLinear || format == PixelFormat::kRgbLinear;
}
[[nodiscard]] constexpr int channel_count(PixelFormat format) {
  return format == PixelFormat::kGrey8 || format == PixelFormat::kGreyLinear ? 1 : 3;
}

enum class RenderQuality {
  kTrilinear,  ///< one trilinear sample per pixel
  kReference,  ///< the mean of 2 x 2 of them, at +-1/4 px
};

/// Homogeneous air between the camera and the ground (Koschmieder's law): the light received from a
/// range d is L exp(-extinction d) + airlight (1 - exp(-extinction d)).
struct Atmosphere {
  double extinction_per_m = 0.0;  ///< 0 = clear; 3.912 / extinction = the meteorological visibility
  /// Of the air at the horizon, in the imagery's encoding (sRGB), in [0, 1].
  std::array<float, 3> airlight_rgb{0.72F, 0.80F, 0.88F};
};

/// A picture that is drawn once every tile at the required detail has been read.
constexpr std::int64_t kForAllTiles = std::numeric_limits<std::int64_t>::max();

/// A request for an image of the aircraft's camera.
struct CameraRequest {
  CameraModel camera;
  CameraMotion T_world_camera;
  std::int64_t t_ns = 0;         ///< mid exposure of the middle row
  std::int64_t exposure_ns = 0;  ///< of each row; 0 = an instant, without motion blur
  /// From the first row's mid exposure to the last row's; 0 = a global shutter. Row y of H is
  /// exposed around t_ns + readout_ns (y / (H - 1) - 1/2).
  std::int64_t readout_ns = 0;
  PixelFormat format = PixelFormat::kGrey8;
  RenderQuality quality = RenderQuality::kTrilinear;
  Atmosphere atmosphere;
  /// Of the camera; used to read tiles ahead, does not change the image.
  Eigen::Vector3d velocity_world_m_s = Eigen::Vector3d::Zero();
  /// Time to read tiles that are not in memory (of each instant, with motion blur). A tile that is
  /// not read in time is replaced by a coarser one, counted, and read for later images. 0 = none.
  std::int64_t tile_wait_ns = kForAllTiles;

  /// A camera at rest.
  static CameraRequest still(const CameraModel& camera,
                             const Pose& T_world_camera,
                             std::int64_t t_ns,
                             PixelFormat format) {
    CameraRequest request;
    request.camera = camera;
    request.T_world_camera = T_world_camera;
    request.t_ns = t_ns;
    request.format = format;
    return request;
  }
  /// Middle of a row's exposure, with rows counted from the top; fractional rows are interpolated.
  [[nodiscard]] std::int64_t row_time_ns(double row) const;
};

/// One image of the aircraft's camera with its metadata: the recorded pose is the pose that was
/// drawn.
struct CameraFrame {
  Image image;             ///< for the 8-bit formats; else empty
  RadianceImage radiance;  ///< for the linear formats; else empty
  std::int64_t t_ns = 0;
  Pose T_world_camera;  ///< at t_ns
  CameraModel camera;
  /// Linear texels of the finest imagery per image pixel, over pixels that see ground with imagery:
  /// below 0.5 the imagery, not the camera, limits the result. 0 if there are no such pixels.
  double texels_per_pixel_min = 0.0;
  double texels_per_pixel_median = 0.0;
  /// Fraction of the image that shows ground without imagery, in [0, 1].
  double void_fraction = 0.0;
  /// Depth of the ground along the optical axis [m]; empty if the axis points to the sky.
  std::optional<double> axis_depth_m;
  /// Tiles that were late and replaced by coarser ones; 0 if the request waited for all.
  int late_tiles = 0;
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
  /// As in CameraRequest.
  std::int64_t tile_wait_ns = kForAllTiles;
};

/// Contents of a scene view in addition to ground and sky.
struct SceneContent {
  struct Aircraft {
    Pose T_world_body;
    std::array<float, 3> rgb{0.9F, 0.1F, 0.1F};
    double wing_span_m = 8.0;
    bool ghost = false;  ///< drawn translucent (an estimate)
  };
  struct Frustum {
    CameraModel camera;
    Pose T_world_camera;
    bool edges = true;      ///< from the optical centre to the corners on the ground
    bool footprint = true;  ///< outline of the image on the ground
  };
  /// A camera's image, laid onto the ground that the camera sees: each point of the ground gets the
  /// colour of its pixel, through the camera's lens.
  struct Projection {
    std::shared_ptr<const Image> image;  ///< grey or RGB, of the camera's size
    CameraModel camera;
    /// While the first and the last row were exposed; in between the camera moves evenly.
    Pose T_world_camera_first;
    Pose T_world_camera_last;
    /// Depth of the ground in an image of the same view, usually smaller: ground that lies behind
    /// it is hidden from the camera and keeps its own colour.
    std::shared_ptr<const DepthImage> depth;
  };
  /// A straight line of constant width in the image.
  struct Line {
    Eigen::Vector3d from_world;
    Eigen::Vector3d to_world;
    std::array<float, 3> rgb{1.0F, 1.0F, 1.0F};
    double width_px = 2.0;
  };
  std::vector<Aircraft> aircraft;
  std::optional<Frustum> frustum;
  std::optional<Projection> projection;
  std::vector<Line> lines;
  std::vector<Ribbon> ribbons;
  /// Map points of an estimator, world frame [m].
  std::vector<Eigen::Vector3f> points;
};

struct RendererInfo {
  std::string backend;     ///< "egl", "raycast" or "noop"
  std::string device;      ///< GL_RENDERER
  std::string gl_version;  ///< GL_VERSION
  bool software = true;    ///< true when the CPU draws
  /// What RendererOptions::device requested, which device is used instead and why; without a
  /// request, the devices that do not work; else empty.
  std::string device_note;
  /// Why the camera is drawn by this backend; empty if there was no choice.
  std::string camera_note;
};

/// Views of one world. Not thread-safe: create, use and destroy on one thread.
class Renderer {
 public:
  virtual ~Renderer() = default;

  /// Draws the camera's image.
  /// Errors: kInvalidArgument for a request refused by check_camera_request, naming the field; kIo
  /// if a tile or a height cannot be read; kUnsupported naming what this renderer does not support.
  [[nodiscard]] virtual Result<CameraFrame> render_camera(const CameraRequest& request) = 0;
  /// Depth along the optical axis of the same image [m], each row at its mid exposure; +infinity
  /// for sky and for pixels without a ray.
  [[nodiscard]] virtual Result<DepthImage> render_depth(const CameraRequest& request) = 0;

  /// As above, for a camera at rest.
  [[nodiscard]] Result<CameraFrame> render_camera(const CameraModel& camera,
                                                  const Pose& T_world_camera,
                                                  std::int64_t t_ns,
                                                  PixelFormat format) {
    return render_camera(CameraRequest::still(camera, T_world_camera, t_ns, format));
  }
  [[nodiscard]] Result<DepthImage> render_depth(const CameraModel& camera,
                                                const Pose& T_world_camera) {
    return render_depth(CameraRequest::still(camera, T_world_camera, 0, PixelFormat::kGrey8));
  }
  /// Draws an RGB view of the scene.
  [[nodiscard]] virtual Result<Image> render_scene(const SceneView& view,
                                                   const SceneContent& content) = 0;
  /// Tells which scene views may be drawn later: their ground is sampled in the background, the
  /// first view first, as long as there is room. Replaces the views told before. Views that
  /// render_scene would refuse are left out. Changes no image.
  virtual void expect_scenes(const std::vector<SceneView>& /*views*/) {}
  [[nodiscard]] virtual RendererInfo info() const = 0;
};

class TileStore;

/// The backend for the aircraft's camera. Scene views are always drawn by OpenGL.
enum class CameraBackend {
  kAuto,  ///< OpenGL on a GPU; without a GPU the ray-caster, which is faster and equally accurate
  kEgl,   ///< OpenGL, on any device
  kRaycast,  ///< the ray-caster on the CPU
};

struct RendererOptions {
  /// Budget for tiles in memory, and the same again for textures; > 64 MiB.
  std::size_t tile_cache_bytes = std::size_t{256} << 20U;
  /// Shared with other renderers of the same world; null = a private one.
  std::shared_ptr<TileStore> tile_store;
  /// The EGL device: "" = the first that works, "0" = by index, "0000:01:00.0" = by PCI address,
  /// "software". If it does not work, the software renderer is used and RendererInfo reports that.
  std::string device;
  CameraBackend camera_backend = CameraBackend::kAuto;  ///< of create_renderer()
  int threads =
      0;  ///< that share a picture; 0 = one per core, at most 8. Does not change the image
};

/// The renderer for this machine: the camera by the backend of the options, scene views by OpenGL.
/// If OpenGL does not work, the camera still does and scene views are kUnsupported.
/// Errors: as create_egl_renderer, only for CameraBackend::kEgl.
[[nodiscard]] Result<std::unique_ptr<Renderer>> create_renderer(
    std::shared_ptr<const terrain::TileSource> tiles, const RendererOptions& options = {});

/// Draws with OpenGL on an EGL device or the surfaceless platform, without a display.
/// Errors: kUnsupported with EGL's error and the missing package.
[[nodiscard]] Result<std::unique_ptr<Renderer>> create_egl_renderer(
    std::shared_ptr<const terrain::TileSource> tiles, const RendererOptions& options = {});

/// Casts rays on the CPU; has no scene views.
[[nodiscard]] std::unique_ptr<Renderer> create_raycast_renderer(
    std::shared_ptr<const terrain::TileSource> tiles, const RendererOptions& options = {});

/// Draws nothing: images are a deterministic pattern of their pose. For tests without EGL.
[[nodiscard]] std::unique_ptr<Renderer> create_noop_renderer(
    std::shared_ptr<const terrain::TileSource> tiles);

/// EGL's capabilities on this machine, without a world (for `overfly doctor`).
[[nodiscard]] Result<RendererInfo> probe_egl(const std::string& device = "");

/// A device that RendererOptions::device can name.
struct GraphicsDevice {
  int index = 0;
  std::string pci_address;  ///< empty if it has none or it is not known
  RendererInfo info;        ///< empty if it does not work
  std::string fault;        ///< why it does not work; empty if it does
};

/// Opens each device listed by EGL once; empty if there is no EGL.
[[nodiscard]] std::vector<GraphicsDevice> list_graphics_devices();

}  // namespace overfly::renderer
