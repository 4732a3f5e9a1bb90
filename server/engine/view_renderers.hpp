// The renderers of the worlds in view.
#pragma once

#include <list>
#include <memory>
#include <string>

#include "core/result.hpp"
#include "renderer/renderer.hpp"
#include "server/engine/run_manager.hpp"

namespace overfly::engine {

/// One renderer per world, the least recently used leaves. Used and destroyed on one thread.
class ViewRenderers {
 public:
  explicit ViewRenderers(RunManager& runs) : runs_(runs) {}

  struct WorldView {
    std::shared_ptr<const terrain::TileSource> tiles;
    std::unique_ptr<renderer::Renderer> renderer;
  };
  /// Valid until the next call. Errors: as RunManager::world and the renderer factory.
  [[nodiscard]] Result<WorldView*> of_run(const std::string& run_id);

 private:
  RunManager& runs_;
  std::list<WorldView> views_;  ///< the one used last is in front
};

}  // namespace overfly::engine
