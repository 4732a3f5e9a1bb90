// The renderers of the worlds in view.
#pragma once

#include <atomic>
#include <list>
#include <memory>
#include <optional>
#include <string>

#include "core/result.hpp"
#include "renderer/renderer.hpp"
#include "server/camera/frame_remaker.hpp"
#include "server/record/rows.hpp"
#include "server/runs/run_manager.hpp"

namespace overfly::engine {

/// One renderer per world, the least recently used leaves. Used and destroyed on one thread.
class ViewRenderers {
 public:
  /// @param stopping  true ends the opening of a world
  ViewRenderers(RunManager& runs, const std::atomic<bool>& stopping)
      : runs_(runs), stopping_(stopping) {}

  struct WorldView {
    std::shared_ptr<const terrain::World> world;
    RendererChoice choice;
    std::unique_ptr<renderer::Renderer> renderer;
    std::string watched_run_id;            ///< the run it was asked for last
    std::string run_id;                    ///< that `frames` makes again
    std::unique_ptr<FrameRemaker> frames;  ///< null until asked for
  };
  /// The view of a run's world, drawn as its scenario asks. Valid until the next call. Errors: as
  /// RunManager::world_of and the renderer factory.
  [[nodiscard]] Result<WorldView*> of_run(const std::string& run_id);
  /// One image of one of the run's cameras, made again. Errors: as of_run and FrameRemaker.
  [[nodiscard]] Result<Image> remake(const std::string& run_id,
                                     std::size_t camera,
                                     const FrameRow& row);

 private:
  [[nodiscard]] Result<const Scenario*> scenario_of(const std::string& run_id);

  RunManager& runs_;
  const std::atomic<bool>& stopping_;
  std::string scenario_run_id_;  ///< whose scenario was read last
  std::optional<Scenario> scenario_;
  std::list<WorldView> views_;  ///< the one used last is in front
};

}  // namespace overfly::engine
