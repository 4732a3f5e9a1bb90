// Draws the camera's image: pinhole images, and images composed from them.
#pragma once

#include <memory>
#include <optional>

#include "core/camera/image.hpp"
#include "core/result.hpp"
#include "renderer/camera/part_sampling.hpp"
#include "renderer/egl/ground_pass.hpp"
#include "renderer/egl/pixel_ring.hpp"
#include "renderer/egl/target_pool.hpp"
#include "renderer/egl/tile_textures.hpp"
#include "renderer/ground/ground_patch.hpp"
#include "renderer/renderer.hpp"

namespace overfly::renderer::egl {

class CameraPass {
 public:
  /// All must outlive the pass.
  CameraPass(GroundPatches& patches, GroundPass& ground, TileTextures& textures)
      : patches_(patches), ground_(ground), textures_(textures) {}

  /// Draws the image or radiance and sets its metadata; other fields of the frame are unchanged.
  /// Errors: kIo if a tile cannot be read; kUnsupported if there is no such framebuffer.
  Status draw(const CameraRequest& request, CameraFrame& frame);
  /// As draw(), but an image that is a single 8-bit pinhole image is copied through the ring.
  /// @return true if it was; the frame's image is then empty
  Result<bool> draw_into(PixelRing& ring, const CameraRequest& request, CameraFrame& frame);
  /// Errors: kUnsupported if there is no such framebuffer.
  Result<DepthImage> depth(const CameraRequest& request);

 private:
  Result<RenderTarget*> draw_plain(const CameraRequest& request, CameraFrame& frame);
  Status draw_composed(const CameraRequest& request, CameraFrame& frame);
  Result<RenderTarget*> draw_picture(const CameraRequest& request,
                                     const GroundMesh& mesh,
                                     const PinholeCamera& camera,
                                     const GroundLook& look,
                                     TargetFormat target);
  const TapRays& rays_of(const CameraModel& camera, RenderQuality quality);

  GroundPatches& patches_;
  GroundPass& ground_;
  TileTextures& textures_;
  TargetPool targets_;
  std::optional<TapRays> rays_;
  ImageBuffer<float> picture_;
};

}  // namespace overfly::renderer::egl
