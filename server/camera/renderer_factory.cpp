#include "server/camera/renderer_factory.hpp"

namespace overfly::server {

Result<std::unique_ptr<renderer::Renderer>> make_renderer(
    const Scenario& scenario,
    const std::shared_ptr<const terrain::TileSource>& tiles,
    const RendererFactory& factory,
    renderer::RendererOptions options) {
  if (factory) return factory(tiles);
  options.device = scenario.renderer.device;
  options.threads = scenario.renderer.threads;
  const std::string& camera = scenario.renderer.camera;
  options.camera_backend = camera == "egl"       ? renderer::CameraBackend::kEgl
                           : camera == "raycast" ? renderer::CameraBackend::kRaycast
                                                 : renderer::CameraBackend::kAuto;
  return renderer::create_renderer(tiles, options);
}

}  // namespace overfly::server
