// Measures the cost of rendering on this machine, as times and in units of one textured quad.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/motion/pose.hpp"
#include "core/result.hpp"
#include "renderer/renderer.hpp"
#include "terrain/tile_source.hpp"

namespace overfly::renderer {

/// Size of the images that the probes draw.
inline constexpr int kProbeWidthPx = 1280;
inline constexpr int kProbeHeightPx = 960;

/// Medians over the repetitions.
struct CallCost {
  double cpu_ms = 0.0;   ///< of the process, including the driver's threads
  double wall_ms = 0.0;  ///< time until the image is in memory
};

/// The unit Q: one full-screen textured quad drawn at 1280 x 960 grey and read back; texture
/// 4096 x 4096 R8 with mip levels, trilinear, rotated by 30 deg, level of detail about 0.5.
class QuadProbe {
 public:
  /// Errors: as create_egl_renderer.
  static Result<std::unique_ptr<QuadProbe>> create(const std::string& device = "");
  virtual ~QuadProbe() = default;
  /// Draws and reads back once. All methods return kInternal if the context is lost.
  virtual Status draw() = 0;
  /// Queues the drawing only.
  virtual Status draw_only() = 0;
  /// Waits until all queued drawing is done.
  virtual Status wait() = 0;
  /// Reads back what was drawn.
  virtual Status read() = 0;
  /// Reads back with three copies in flight; takes the oldest when all are in use.
  virtual Status read_piped() = 0;
  [[nodiscard]] virtual RendererInfo info() const = 0;
};

/// All values except the last two are for OpenGL.
struct RenderCosts {
  CallCost quad;
  CallCost camera_grey;  ///< 1280 x 960
  CallCost camera_rgb;   ///< 1280 x 960
  CallCost depth;        ///< 1280 x 960
  CallCost scene;        ///< 960 x 720
  /// camera_grey / quad by CPU time: the median of the ratios of neighbouring calls, which other
  /// load on the machine affects less than the ratio of the medians.
  double camera_per_quad = 0.0;
  /// The same ratio for the ray-caster with one thread, for camera_grey at the given poses: level,
  /// and banked by 45 deg.
  double raycast_per_quad = 0.0;
  double raycast_banked_per_quad = 0.0;
};

/// Measures the views of a world along camera poses, each alternating with the quad.
/// @param T_world_camera  at least one; used in turn, each once before measuring
/// @param repetitions  of each view, >= 1
/// Errors: as create_egl_renderer and the renderer's methods.
[[nodiscard]] Result<RenderCosts> measure_render_costs(
    const std::shared_ptr<const terrain::TileSource>& tiles,
    const std::vector<Pose>& T_world_camera,
    int repetitions,
    const std::string& device = "");

/// The limits of the camera's frame rate at 1280 x 960 grey on this machine, and the rate reached.
struct RateCosts {
  RendererInfo renderer;
  double memcpy_ms = 0.0;    ///< of the image's bytes between two buffers in memory
  double readback_ms = 0.0;  ///< of an image that has been drawn
  double readback_per_memcpy = 0.0;
  double fill_per_s = 0.0;  ///< quads drawn but not read back: limit of the fill rate
  double copy_per_s = 0.0;  ///< images read back but not drawn: limit of the copy rate
  /// Camera frames drawn and copied to memory, by the number in flight.
  struct Rate {
    int in_flight = 1;
    double per_s = 0.0;
  };
  std::vector<Rate> camera;
};

/// Measures all rates alternately, `rounds` times; returns medians.
/// @param T_world_camera  at least one
/// Errors: as measure_render_costs.
[[nodiscard]] Result<RateCosts> measure_rate_costs(
    const std::shared_ptr<const terrain::TileSource>& tiles,
    const std::vector<Pose>& T_world_camera,
    int rounds,
    const std::string& device);

}  // namespace overfly::renderer
