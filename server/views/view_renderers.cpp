#include "server/views/view_renderers.hpp"

#include <algorithm>
#include <utility>

#include "server/camera/watched_tiles.hpp"
#include "server/record/rows/rows.hpp"
#include "server/views/tiles_along.hpp"

namespace overfly::server {
namespace {

/// Each keeps its tiles as textures: viewers can compare runs over this many worlds without
/// reloading them.
constexpr std::size_t kMaxRenderers = 4;
/// Runs of one world whose frames can be made without reading their scenario again: as many as a
/// viewer watches.
constexpr std::size_t kMaxRuns = 16;
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

ViewRenderers::WorldView* ViewRenderers::known_view(const std::string& run_id) {
  for (auto view = views_.begin(); view != views_.end(); ++view) {
    const auto watched = std::find_if(view->runs.begin(), view->runs.end(), [&](const auto& run) {
      return run.run_id == run_id;
    });
    if (watched == view->runs.end()) continue;
    if (!view->tiles->tiles().status()) {
      damaged_run_id_ = run_id;
      continue;
    }
    view->runs.splice(view->runs.begin(), view->runs, watched);
    views_.splice(views_.begin(), views_, view);
    return &views_.front();
  }
  return nullptr;
}

void ViewRenderers::read_ground(const WorldView& view, const std::string& run_id) {
  const auto timeline = runs_.timeline(run_id);
  if (!timeline) return;
  // Previews of the camera need the second level and coarser ones; scenes look from farther away.
  const terrain::TileSource& tiles = *view.world->tiles;
  view.tiles->read_when_idle(tiles_along(**timeline, tiles, 2, 2.0), renderer::PixelFormat::kRgb8);
  view.tiles->read_when_idle(tiles_along(**timeline, tiles, 1, 1.0), renderer::PixelFormat::kGrey8);
}

Result<ViewRenderers::WorldView*> ViewRenderers::of_run(const std::string& run_id) {
  // A viewer of a run keeps its world even if the files change.
  if (WorldView* known = known_view(run_id)) return known;
  const Result<const Scenario*> scenario = scenario_of(run_id);
  if (!scenario) return scenario.error();
  const auto opened = worlds_.take(run_id);
  if (!opened) return nullptr;
  const Result<WorldOpener::World>& world = *opened;
  if (!world) return world.error();
  const RendererChoice& choice = (*scenario)->renderer;
  const auto same = std::find_if(views_.begin(), views_.end(), [&](const WorldView& view) {
    return view.world == *world && view.choice == choice && view.tiles->tiles().status();
  });
  if (same != views_.end()) {
    views_.splice(views_.begin(), views_, same);
  } else {
    while (views_.size() >= kMaxRenderers) views_.pop_back();
    auto tiles = std::make_shared<const WatchedTiles>((*world)->tiles, &stopping_);
    renderer::RendererOptions options;
    options.tile_cache_bytes = kTileCacheBytes;
    options.tile_store = std::make_shared<renderer::TileStore>(
        tiles, renderer::TileStoreOptions{kTileCacheBytes, 1});
    auto renderer = make_renderer(**scenario, tiles, runs_.renderer_factory(), options);
    if (!renderer) return renderer.error();
    views_.push_front({*world, choice, options.tile_store, std::move(*renderer), {}});
  }
  WorldView& view = views_.front();
  // A renderer of the factory has its own tiles.
  if (!runs_.renderer_factory() && damaged_run_id_ != run_id) read_ground(view, run_id);
  view.runs.push_front({run_id, nullptr, damaged_run_id_ == run_id});
  if (view.runs.size() > kMaxRuns) view.runs.pop_back();
  return &view;
}

Result<std::optional<ViewRenderers::Frames>> ViewRenderers::frames_of(const std::string& run_id) {
  const Result<WorldView*> view = of_run(run_id);
  if (!view) return view.error();
  if (*view == nullptr) return std::optional<Frames>();
  WorldView& found = **view;
  std::unique_ptr<FrameRemaker>& frames = found.runs.front().frames;
  if (!frames) {
    const Result<const Scenario*> scenario = scenario_of(run_id);
    if (!scenario) return scenario.error();
    const auto folder = runs_.folder(run_id);
    if (!folder) return folder.error();
    auto created = FrameRemaker::create(*folder, **scenario, found.world);
    if (!created) return created.error();
    frames = std::move(*created);
  }
  return std::optional(Frames{*found.renderer, *frames, *found.world});
}

void ViewRenderers::drop_deleted() {
  for (WorldView& view : views_) {
    for (WorldView::Watched& run : view.runs) {
      if (run.frames && !runs_.folder(run.run_id)) run.frames.reset();
    }
  }
}

}  // namespace overfly::server
