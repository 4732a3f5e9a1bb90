// A renderer around another one, for tests that change single calls.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "renderer/renderer.hpp"

namespace overfly::server::testing {

/// Forwards every call. A test overrides the call that it changes and uses inner() in it.
class WrappedRenderer : public renderer::Renderer {
 public:
  explicit WrappedRenderer(std::unique_ptr<renderer::Renderer> inner) : inner_(std::move(inner)) {}
  using Renderer::render_camera;
  using Renderer::render_depth;
  Result<renderer::CameraFrame> render_camera(const renderer::CameraRequest& request) override {
    return inner_->render_camera(request);
  }
  Result<DepthImage> render_depth(const renderer::CameraRequest& request) override {
    return inner_->render_depth(request);
  }
  Result<Image> render_scene(const renderer::SceneView& view,
                             const renderer::SceneContent& content) override {
    return inner_->render_scene(view, content);
  }
  void expect_scenes(const std::vector<renderer::SceneView>& views) override {
    inner_->expect_scenes(views);
  }
  renderer::RendererInfo info() const override { return inner_->info(); }

 protected:
  [[nodiscard]] renderer::Renderer& inner() { return *inner_; }

 private:
  std::unique_ptr<renderer::Renderer> inner_;
};

}  // namespace overfly::server::testing
