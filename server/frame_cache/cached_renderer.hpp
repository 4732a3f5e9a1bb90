// A renderer that takes pictures of the camera from a frame cache.
#pragma once

#include <memory>
#include <string>

#include "renderer/renderer.hpp"
#include "server/frame_cache/frame_cache.hpp"

namespace overfly::server {

/// Pictures that the cache lacks are drawn by the other renderer and added. All other views, and
/// pictures that need not be complete (CameraRequest::tile_wait_ns), are always drawn.
class CachedRenderer final : public renderer::Renderer {
 public:
  /// @param context  as picture_context
  /// @param cache  must outlive the renderer
  CachedRenderer(std::unique_ptr<renderer::Renderer> renderer,
                 std::string context,
                 FrameCache& cache)
      : renderer_(std::move(renderer)), context_(std::move(context)), cache_(cache) {}

  /// Whether reading a picture is cheaper than drawing it again: not if a GPU draws.
  [[nodiscard]] static bool pays_for(const renderer::RendererInfo& info) { return info.software; }

  using Renderer::render_camera;
  using Renderer::render_depth;
  [[nodiscard]] Result<renderer::CameraFrame> render_camera(
      const renderer::CameraRequest& request) override;
  [[nodiscard]] Result<DepthImage> render_depth(const renderer::CameraRequest& request) override {
    return renderer_->render_depth(request);
  }
  [[nodiscard]] Result<Image> render_scene(const renderer::SceneView& view,
                                           const renderer::SceneContent& content) override {
    return renderer_->render_scene(view, content);
  }
  [[nodiscard]] renderer::RendererInfo info() const override { return renderer_->info(); }

 private:
  std::unique_ptr<renderer::Renderer> renderer_;
  std::string context_;
  FrameCache& cache_;
};

}  // namespace overfly::server
