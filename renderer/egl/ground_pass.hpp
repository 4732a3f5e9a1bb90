// Draws a ground mesh.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/result.hpp"
#include "renderer/egl/gl_objects.hpp"
#include "renderer/egl/gl_program.hpp"
#include "renderer/egl/image_projection.hpp"
#include "renderer/egl/tile_textures.hpp"
#include "renderer/ground/ground_mesh.hpp"
#include "renderer/renderer.hpp"

namespace overfly::renderer::egl {

/// Near clipping distance [m].
inline constexpr float kNearM = 0.05F;

/// Colour of the air at the horizon in scene views.
inline constexpr float kHazeRgb[3] = {0.84F, 0.89F, 0.93F};

/// Sets the uniform `projection` (fx', fy', cx', cy') of a program: clip coordinates of a point (x,
/// y, z) of the camera frame are (fx' x + cx' z, fy' y + cy' z, kNearM, z). Depth is then kNearM /
/// z: 1 at the near plane, 0 at infinity, and precise as a float at all distances. The window's row
/// 0 is the image's row 0, and the centre of pixel i is at window i + 0.5.
void set_projection(const GlProgram& program, const PinholeCamera& camera);

/// Appearance of the ground.
struct GroundLook {
  enum class Output {
    kColour,
    kHazyColour,  ///< fades into kHazeRgb with distance; ground without imagery is earth-coloured
    kDepthM,
  };
  Output output = Output::kColour;
  PixelFormat format = PixelFormat::kGrey8;  ///< of the textures; ignored for depth
  std::int64_t tile_wait_ns = kForAllTiles;  ///< see CameraRequest
  /// For kColour: the air between the camera and the ground, with its light in the format's
  /// encoding.
  double extinction_per_m = 0.0;
  std::array<float, 3> airlight{};
  /// For kHazyColour: an image on the ground; null = none.
  const ImageProjection* projection = nullptr;
  /// For kColour: added to the level of detail at the image's corners, bilinear in between.
  std::array<float, 4> lod_bias{};
};

class GroundPass {
 public:
  static Result<GroundPass> create();

  /// Draws into the bound target, which is cleared except for colour.
  /// Errors: kIo if a tile cannot be read.
  Status draw(const GroundMesh& mesh,
              const PinholeCamera& camera,
              TileTextures& textures,
              const GroundLook& look);

 private:
  GroundPass(
      GlProgram colour, GlProgram airy, GlProgram hazy, GlProgram projected, GlProgram depth);
  Status find_textures(const GroundMesh& mesh, TileTextures& textures, const GroundLook& look);
  const GlProgram& use_program(const GroundLook& look, const PinholeCamera& camera);
  void upload(const GroundMesh& mesh);

  GlProgram colour_, airy_, hazy_, projected_, depth_;
  GlVertexArray vertex_array_;
  GlBuffer vertices_, indices_;
  std::vector<DrawnTile> tiles_;  // of the batches being drawn
};

}  // namespace overfly::renderer::egl
