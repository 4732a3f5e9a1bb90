#include "server/frame_cache/cached_renderer.hpp"

#include <optional>

#include "server/frame_cache/frame_key.hpp"

namespace overfly::server {

Result<renderer::CameraFrame> CachedRenderer::render_camera(
    const renderer::CameraRequest& request) {
  if (request.tile_wait_ns != renderer::kForAllTiles) return renderer_->render_camera(request);
  const std::string key = frame_key(context_, request);
  if (std::optional<renderer::CameraFrame> known = cache_.find(key, request)) {
    return std::move(*known);
  }
  Result<renderer::CameraFrame> drawn = renderer_->render_camera(request);
  if (drawn && drawn->late_tiles == 0) cache_.add(key, *drawn);
  return drawn;
}

}  // namespace overfly::server
