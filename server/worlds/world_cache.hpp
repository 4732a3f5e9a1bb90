// Opened worlds, shared between the runs and views that use them at the same time.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "core/result.hpp"
#include "server/worlds/scenario_world.hpp"

namespace overfly::server {

/// Thread-safe. A world is closed when its last user releases it, except the most recently
/// requested one. If a world's files have changed since it was opened, its present users keep it
/// and the next request opens it again.
class WorldCache {
 public:
  using Shared = std::shared_ptr<const OpenedWorld>;

  /// @param progress  as of open_scenario_world
  /// Errors: as open_scenario_world.
  [[nodiscard]] Result<Shared> get(const Scenario& scenario,
                                   const std::function<bool(double)>& progress);
  /// Makes the next request open the world again, because it could not be read.
  void drop(const Shared& world);

 private:
  [[nodiscard]] Shared find(const std::string& key);

  std::mutex mutex_;
  std::map<std::string, std::weak_ptr<const OpenedWorld>> worlds_;
  Shared last_;
};

/// The world without its file information; keeps the whole alive.
[[nodiscard]] inline std::shared_ptr<const terrain::World> bare_world(
    const WorldCache::Shared& opened) {
  return {opened, &opened->world};
}

}  // namespace overfly::server
