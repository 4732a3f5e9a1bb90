// Draws a scene view: sky, hazy ground, and the objects above it.
#pragma once

#include <cstdint>
#include <optional>

#include "core/camera/image.hpp"
#include "core/result.hpp"
#include "renderer/egl/ground_pass.hpp"
#include "renderer/egl/render_target.hpp"
#include "renderer/renderer.hpp"
#include "renderer/scene/scene_triangles.hpp"

namespace overfly::renderer::egl {

class ScenePass {
 public:
  static Result<ScenePass> create();

  /// Errors: kIo if a tile cannot be read; kUnsupported if there is no such framebuffer.
  Result<Image> draw(const SceneContent& content,
                     const View& view,
                     const terrain::TileSource& tiles,
                     GroundPatches& patches,
                     GroundPass& ground,
                     TileTextures& textures,
                     std::int64_t tile_wait_ns);

 private:
  ScenePass(GlProgram sky, GlProgram overlay);
  Status prepare_target(const PinholeCamera& camera);
  void draw_sky(const View& view);
  void draw_triangles(const SceneTriangles& triangles, bool translucent);

  GlProgram sky_, overlay_;
  GlVertexArray no_vertices_, vertex_array_;
  GlBuffer vertices_;
  ImageProjection projection_;
  std::optional<RenderTarget> target_;
};

}  // namespace overfly::renderer::egl
