// Opened worlds, shared between the runs and views that use them at the same time.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "core/result.hpp"
#include "server/engine/scenario.hpp"
#include "terrain/world.hpp"

namespace overfly::engine {

/// Thread-safe. A world is closed when its last user lets it go, except the one asked for last.
class WorldCache {
 public:
  /// @param progress  of making the built-in world; false cancels
  /// Errors: as open_scenario_world.
  [[nodiscard]] Result<std::shared_ptr<const terrain::World>> get(
      const Scenario& scenario, const std::function<bool(double)>& progress);
  /// Has the world opened anew by whoever asks for it next: it could not be read.
  void drop(const std::shared_ptr<const terrain::World>& world);

 private:
  [[nodiscard]] std::shared_ptr<const terrain::World> find(const std::string& key);

  std::mutex mutex_;
  std::map<std::string, std::weak_ptr<const terrain::World>> worlds_;
  std::shared_ptr<const terrain::World> last_;
};

}  // namespace overfly::engine
