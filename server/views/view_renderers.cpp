#include "server/views/view_renderers.hpp"

#include <algorithm>
#include <utility>

#include "server/camera/watched_tiles.hpp"
#include "server/record/rows/rows.hpp"

namespace overfly::server {
namespace {

/// Each keeps its tiles as textures: viewers can compare runs over this many worlds without
/// reloading them.
constexpr std::size_t kMaxRenderers = 4;
/// Of each, for tiles in memory, and the same again for textures.
constexpr std::size_t kTileCacheBytes = std::size_t{128} << 20U;

}  // namespace

Result<const Scenario*> ViewRenderers::scenario_of(const std::string& run_id) {
  if (!scenario_ || scenario_run_id_ != run_id) {
    Result<Scenario> read = runs_.scenario_of(run_id);
    if (!read) return read.error();
    scenario_ = std::move(*read);
    scenario_run_id_ = run_id;
  }
  return &*scenario_;
}

Result<ViewRenderers::WorldView*> ViewRenderers::of_run(const std::string& run_id) {
  // A viewer of a run keeps its world even if the files change.
  const auto watched = std::find_if(views_.begin(), views_.end(), [&](const WorldView& view) {
    return view.watched_run_id == run_id && view.world->tiles->status();
  });
  if (watched != views_.end()) {
    views_.splice(views_.begin(), views_, watched);
    return &views_.front();
  }
  const Result<const Scenario*> scenario = scenario_of(run_id);
  if (!scenario) return scenario.error();
  const auto opened = worlds_.take(run_id);
  if (!opened) return nullptr;
  const Result<WorldOpener::World>& world = *opened;
  if (!world) return world.error();
  const RendererChoice& choice = (*scenario)->renderer;
  const auto known = std::find_if(views_.begin(), views_.end(), [&](const WorldView& view) {
    return view.world == *world && view.choice == choice;
  });
  if (known != views_.end()) {
    views_.splice(views_.begin(), views_, known);
    views_.front().watched_run_id = run_id;
    return &views_.front();
  }
  while (views_.size() >= kMaxRenderers) views_.pop_back();
  auto tiles = std::make_shared<const WatchedTiles>((*world)->tiles, &stopping_);
  auto renderer =
      make_renderer(**scenario, std::move(tiles), runs_.renderer_factory(), kTileCacheBytes);
  if (!renderer) return renderer.error();
  views_.push_front({*world, choice, std::move(*renderer), run_id, "", nullptr});
  return &views_.front();
}

Result<std::optional<Image>> ViewRenderers::remake(const std::string& run_id,
                                                   std::size_t camera,
                                                   const FrameRow& row) {
  const Result<WorldView*> view = of_run(run_id);
  if (!view) return view.error();
  if (*view == nullptr) return std::optional<Image>();
  WorldView& found = **view;
  if (!found.frames || found.run_id != run_id) {
    const Result<const Scenario*> scenario = scenario_of(run_id);
    if (!scenario) return scenario.error();
    const auto folder = runs_.folder(run_id);
    if (!folder) return folder.error();
    auto frames = FrameRemaker::create(*folder, **scenario, found.world);
    if (!frames) return frames.error();
    found.frames = std::move(*frames);
    found.run_id = run_id;
  }
  Result<Image> image = found.frames->make(camera, row, *found.renderer);
  if (!image) return image.error();
  return std::optional<Image>(std::move(*image));
}

}  // namespace overfly::server
