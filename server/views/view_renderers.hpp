// The renderers of the viewed worlds.
#pragma once

#include <atomic>
#include <list>
#include <memory>
#include <optional>
#include <string>

#include "core/result.hpp"
#include "renderer/renderer.hpp"
#include "renderer/tiles/tile_store.hpp"
#include "server/camera/frame_remaker.hpp"
#include "server/record/rows/rows.hpp"
#include "server/runs/run_manager.hpp"
#include "server/views/world_opener.hpp"

namespace overfly::server {

/// One renderer per world; the least recently used one is evicted. Used and destroyed on one
/// thread.
class ViewRenderers {
 public:
  /// @param worlds  must outlive this
  /// @param stopping  true cancels the reading of tiles
  ViewRenderers(RunManager& runs, WorldOpener& worlds, const std::atomic<bool>& stopping)
      : runs_(runs), worlds_(worlds), stopping_(stopping) {}

  struct WorldView {
    std::shared_ptr<const terrain::World> world;
    RendererChoice choice;
    std::shared_ptr<renderer::TileStore> tiles;
    std::unique_ptr<renderer::Renderer> renderer;
    struct Watched {
      std::string run_id;
      std::unique_ptr<FrameRemaker> frames;  ///< null until needed
      bool scenes_expected = false;  ///< the renderer knows the scenes along it, or must not
    };
    std::list<Watched> runs;  ///< most recently used first; never empty
  };
  /// The view of a run's world, drawn with the scenario's settings. Valid until the next call. Null
  /// while the world is being opened. Errors: as RunManager::world_of and the renderer factory.
  [[nodiscard]] Result<WorldView*> of_run(const std::string& run_id);
  /// What makes a run's frames again.
  struct Frames {
    renderer::Renderer& renderer;
    FrameRemaker& maker;
    const terrain::World& world;
  };
  /// Valid until the next call; empty while the run's world is being opened.
  /// Errors: as of_run and FrameRemaker::create.
  [[nodiscard]] Result<std::optional<Frames>> frames_of(const std::string& run_id);
  /// Closes the files of runs that were deleted.
  void drop_deleted();

 private:
  /// Requests the ground below the run's flight, so that a jump in time finds it in memory.
  void read_ground(const WorldView& view, const std::string& run_id);
  [[nodiscard]] Result<const Scenario*> scenario_of(const std::string& run_id);
  /// The view that was given to the run earlier; null if there is none that still works.
  WorldView* known_view(const std::string& run_id);

  RunManager& runs_;
  WorldOpener& worlds_;
  const std::atomic<bool>& stopping_;
  std::string scenario_run_id_;  ///< the run whose scenario was read last
  std::optional<Scenario> scenario_;
  /// The run whose files could not be read the last time: nothing is read ahead for it, which would
  /// meet the damage again although no picture shows it.
  std::string damaged_run_id_;
  std::list<WorldView> views_;  ///< most recently used first
};

}  // namespace overfly::server
