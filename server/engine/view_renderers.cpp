#include "server/engine/view_renderers.hpp"

#include <algorithm>
#include <utility>

namespace overfly::engine {
namespace {

/// Each keeps its tiles as textures: a viewer may go back and forth between two worlds.
constexpr std::size_t kMaxRenderers = 2;

}  // namespace

Result<ViewRenderers::WorldView*> ViewRenderers::of_run(const std::string& run_id) {
  auto tiles = runs_.world(run_id);
  if (!tiles) return tiles.error();
  const auto known = std::find_if(
      views_.begin(), views_.end(), [&](const WorldView& view) { return view.tiles == *tiles; });
  if (known != views_.end()) {
    views_.splice(views_.begin(), views_, known);
    return &views_.front();
  }
  while (views_.size() >= kMaxRenderers) views_.pop_back();
  const RendererFactory& factory = runs_.renderer_factory();
  auto renderer = factory ? factory(*tiles) : renderer::create_egl_renderer(*tiles);
  if (!renderer) return renderer.error();
  views_.push_front({*tiles, std::move(*renderer)});
  return &views_.front();
}

}  // namespace overfly::engine
