#include "renderer/raycast/raycast_renderer.hpp"

#include <string>

#include "renderer/raycast/frame_caster.hpp"
#include "renderer/request_check.hpp"

namespace overfly::renderer::raycast {

namespace {

class RaycastRenderer final : public Renderer {
 public:
  RaycastRenderer(std::shared_ptr<const terrain::TileSource> tiles, const RaycastOptions& options)
      : tiles_(std::move(tiles)), caster_(tiles_, options) {}

  using Renderer::render_camera;
  using Renderer::render_depth;

  Result<CameraFrame> render_camera(const CameraRequest& request) override {
    if (Status status = check_camera_request(*tiles_, request); !status) return status.error();
    Result<CameraFrame> frame = caster_.draw(request);
    if (Status status = tiles_->status(); !status) return status.error();
    return frame;
  }

  Result<DepthImage> render_depth(const CameraRequest& request) override {
    if (Status status = check_camera_request(*tiles_, request); !status) return status.error();
    DepthImage depth = caster_.depth(request);
    if (Status status = tiles_->status(); !status) return status.error();
    return depth;
  }

  Result<Image> render_scene(const SceneView& /*view*/, const SceneContent& /*content*/) override {
    return Error{ErrorCode::kUnsupported,
                 "the ray-caster draws only the aircraft's camera; scene views need EGL"};
  }

  [[nodiscard]] RendererInfo info() const override {
    RendererInfo info;
    info.backend = "raycast";
    info.device = "CPU, " + std::to_string(caster_.threads()) +
                  (caster_.threads() == 1 ? " thread, " : " threads, ") + caster_.kernel().name;
    info.gl_version = "none";
    info.software = true;
    return info;
  }

 private:
  std::shared_ptr<const terrain::TileSource> tiles_;
  FrameCaster caster_;
};

}  // namespace

std::unique_ptr<Renderer> create_raycaster(std::shared_ptr<const terrain::TileSource> tiles,
                                           const RaycastOptions& options) {
  return std::make_unique<RaycastRenderer>(std::move(tiles), options);
}

}  // namespace overfly::renderer::raycast

namespace overfly::renderer {

std::unique_ptr<Renderer> create_raycast_renderer(std::shared_ptr<const terrain::TileSource> tiles,
                                                  const RendererOptions& options) {
  raycast::RaycastOptions chosen;
  chosen.tile_cache_bytes = options.tile_cache_bytes;
  chosen.tile_store = options.tile_store;
  chosen.threads = options.threads;
  return raycast::create_raycaster(std::move(tiles), chosen);
}

}  // namespace overfly::renderer
