// What drawing costs on this machine, as times and in units of one textured quad.
#pragma once

#include <memory>
#include <vector>

#include "core/pose.hpp"
#include "core/result.hpp"
#include "renderer/renderer.hpp"
#include "terrain/tile_source.hpp"

namespace overfly::renderer {

/// Medians over the repetitions.
struct CallCost {
  double cpu_ms = 0.0;   ///< CPU time of the process, the driver's threads included
  double wall_ms = 0.0;  ///< time until the image is in memory
};

/// The unit Q: one full-screen textured quad drawn at 1280 x 960 grey and read back; texture
/// 4096 x 4096 R8 with mip levels, trilinear, rotated by 30 deg, level of detail about 0.5.
class QuadProbe {
 public:
  /// Errors: as create_egl_renderer.
  static Result<std::unique_ptr<QuadProbe>> create();
  virtual ~QuadProbe() = default;
  /// Draws and reads back once. Errors: kInternal when the context is lost.
  virtual Status draw() = 0;
};

struct RenderCosts {
  CallCost quad;
  CallCost camera_grey;  ///< 1280 x 960
  CallCost camera_rgb;   ///< 1280 x 960
  CallCost depth;        ///< 1280 x 960
  CallCost scene;        ///< 960 x 720
  /// camera_grey / quad by CPU time: the median of the ratios of neighbouring calls, which a
  /// busy machine disturbs less than the ratio of the medians.
  double camera_per_quad = 0.0;
};

/// Measures the views of a world along camera poses, each in turn with the quad.
/// @param T_world_camera  at least one; used in turn, all once before measuring
/// @param repetitions     of each view, >= 1
/// Errors: as create_egl_renderer and the renderer's methods.
[[nodiscard]] Result<RenderCosts> measure_render_costs(
    const std::shared_ptr<const terrain::TileSource>& tiles,
    const std::vector<Pose>& T_world_camera,
    int repetitions);

}  // namespace overfly::renderer
